// Elements that are brought up to date in place (src/monitor/page/patch.ts).
import assert from 'node:assert/strict';
import {openPage} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';

await openPage(process.argv[2], '<div id="root"></div>');
const {el, patch, setText} = await pageModule(process.argv[2], 'patch', 'dom');
const root = document.getElementById('root');
const item = (key, text = key) => el('li', {'data-key': key}, el('button', {type: 'button'}, text));
const show = (...children) => patch(root, children);
const html = () => root.innerHTML.replace(/ (data-key|type)="\w+"/g, '');

// Elements of the same key stay, whatever comes before them or goes; the rest is as it is wanted.
show(item('a'), item('b'), item('c'));
const [a, b, c] = root.children;
show(item('x'), item('b', 'new words'), item('c'), item('y'));
assert.equal(html(), ['x', 'new words', 'c', 'y'].map((t) => `<li><button>${t}</button></li>`).join(''));
assert.deepEqual([root.children[1] === b, root.children[2] === c, a.parentNode], [true, true, null]);
const moves = [];
const {insertBefore} = root;
root.insertBefore = function (node, before) {
  moves.push(node);
  return insertBefore.call(this, node, before);
};
show(item('w'), item('x'), item('b'), item('c'), item('y'));
assert.equal(moves.length, 1, 'elements that stay are not moved: that takes their focus');
show(item('c'), item('b'));
assert.deepEqual([...root.children], [c, b]);

// Others stay in their place if they are of the same kind, with new texts, attributes and handlers.
const pressed = [];
const button = (n) =>
  Object.assign(el('button', {class: `k${n}`, ...(n === 1 ? {title: 't'} : {})}, `No. ${n}`), {
    onclick: () => pressed.push(n),
  });
show(el('p', {}, 'one ', el('b', {}, 'two')), button(1));
const [p, first] = root.children;
show(el('p', {}, 'one ', el('b', {}, '2'), ' three'), button(2));
assert.deepEqual([...root.children], [p, first]);
assert.equal(root.innerHTML, '<p>one <b>2</b> three</p><button class="k2">No. 2</button>');
first.onclick();
assert.deepEqual(pressed, [2]);
show(el('h2', {}, 'other'));
assert.equal(root.innerHTML, '<h2>other</h2>');

// Nothing is written where nothing differs, so that a screen reader does not read it again.
const written = [];
const texts = () => el('p', {'aria-live': 'polite'}, 'all is well');
show(texts());
const node = root.firstChild.firstChild;
show(texts());
assert.equal(root.firstChild.firstChild, node);
const proxy = {get textContent() { return 'same'; }, set textContent(text) { written.push(text); }}; // prettier-ignore
setText(proxy, 'same');
setText(proxy, 'other');
assert.deepEqual(written, ['other']);

// An element that its owner keeps, as a chart, is the same afterwards; a menu has the value that is wanted.
const chart = el('div', {'data-key': 'chart'}, el('canvas'));
const menu = (value) =>
  Object.assign(el('select', {}, el('option', {value: 'x'}, 'x'), el('option', {value: 'y'}, 'y')), {value});
show(chart, menu('y'));
const [, select] = root.children;
show(el('h2', {}, 'before'), chart, menu('x'));
assert.deepEqual([root.children[1], root.children[1].children.length], [chart, 1]);
assert.equal(select.parentNode, root);
assert.equal(select.value, 'x');

// The page's security policy refuses a style that is set as an attribute.
const wide = (px) => el('p', {style: `width:${px}px`}, 'bar');
show(wide(3));
const [bar] = root.children;
const style = {};
Object.defineProperty(bar, 'style', {value: style});
show(wide(4));
assert.equal(root.children[0], bar);
assert.match(style.cssText, /width: ?4px/);
