// The style of points (src/monitor/page/point_material.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';

const {kModes, kPointSize, pointMaterial, pointStyle, rgbOf} = await pageModule(process.argv[2], 'point_material');

// A change of the style reaches the shader without a new material, and materials do not share styles of others.
const style = pointStyle(),
  material = pointMaterial(style);
style.mode.value = kModes.intensity;
assert.equal(material.uniforms.mode.value, 2);
assert.equal(pointMaterial(pointStyle()).uniforms.mode.value, 0);

// Each uniform that the shader declares is set, and the reverse.
const declared = [...material.vertexShader.matchAll(/uniform \w+ ([\w, ]+);/g)].flatMap(([, names]) =>
  names.split(', '),
);
assert.deepEqual(declared.sort(), Object.keys(material.uniforms).sort());
for (const size of [kPointSize.metres, kPointSize.min]) assert.ok(material.vertexShader.includes(String(size)));

const {r, g, b} = rgbOf('#ff8000');
assert.deepEqual(
  [r, g, b].map((one) => Math.round(255 * one)),
  [255, 128, 0],
  'as written, without a tone curve',
);
