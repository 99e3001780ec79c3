// Shading of a picture of points (src/monitor/page/shading.ts): the uniforms of its shader.
import assert from 'node:assert/strict';
import {pageModule, three} from './page_module.mjs';

const {Shading} = await pageModule(process.argv[2], 'shading');
const {OrthographicCamera, PerspectiveCamera, Texture} = await three(process.argv[2]);
const picture = {colours: new Texture(), depths: new Texture()};
const uniformsOf = (camera, shaded) => {
  let values;
  const render = (scene) => {
    const {material} = scene.children[0];
    const declared = [...material.fragmentShader.matchAll(/uniform \w+ ([\w, ]+);/g)].flatMap(([, names]) =>
      names.split(', '),
    );
    assert.deepEqual(declared.sort(), Object.keys(material.uniforms).sort());
    values = Object.fromEntries(Object.entries(material.uniforms).map(([name, {value}]) => [name, value]));
    assert.equal(material.depthTest || material.depthWrite, false, 'it hides nothing that is drawn later');
  };
  new Shading().draw({render, getPixelRatio: () => 2}, picture, {camera, width: 200, height: 100}, 0.01, shaded);
  return values;
};

const far = uniformsOf(new PerspectiveCamera(50, 2, 0.5, 900), true);
assert.equal(far.colours, picture.colours);
assert.equal(far.depths, picture.depths);
assert.deepEqual(far.texel.toArray(), [1 / 200, 1 / 100]);
assert.deepEqual([far.near, far.far, far.planar, far.pixelAtOne, far.radius], [0.5, 900, 0, 0.01, 2]);
assert.ok(far.strength > 0);
const plan = uniformsOf(new OrthographicCamera(-1, 1, 1, -1, 1, 50), false);
assert.equal(plan.planar, 1, 'depths of a plan are linear');
assert.equal(plan.strength, 0, 'colours as they are');
