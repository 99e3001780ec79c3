// The card of what is selected (src/monitor/page/card_box.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';

await openPage(process.argv[2], '<div id="map"></div><div id="card" hidden></div>');
const {CardBox, el} = await pageModule(process.argv[2], 'card_box', 'dom');
const [map, card] = ['map', 'card'].map((id) => document.getElementById(id));
const scrolled = [];
for (const one of [map, card]) one.scrollIntoView = () => scrolled.push(one.id);
window.scrollTo = (x, y) => scrolled.push(y);
window.scrollY = 900;
let closed = 0;
const narrow = {matches: false};
const box = new CardBox(card, map, () => (++closed, box.show(null)), narrow);
const heading = (text) => [el('h2', {}, text), el('p', {}, 'words')];
const close = () => card.querySelector('.close').onclick();

// In a wide window the card lies over the map, and nothing scrolls.
box.show(heading('a'), true);
assert.match(textOf(card), /a.*words/);
close();
assert.deepEqual([card.hidden, closed, scrolled], [true, 1, []]);

// In a narrow one the map and the card come into view, and the list where it was read when the card is closed.
narrow.matches = true;
box.show(heading('a'), true);
window.scrollY = 0;
box.show(heading('b'), true);
close();
assert.deepEqual(scrolled.splice(0), ['map', 'card', 'map', 'card', 900]);
box.show(heading('tapped on the map'));
close();
assert.deepEqual(scrolled.splice(0), ['map', 'card']);

// New words go into the card that is open; the buttons that compare clouds stay as they are pressed.
const compare = el('div', {class: 'compare'}, el('button', {'aria-pressed': 'true'}, 'as placed'));
box.show([...heading('a'), compare]);
const [button, first] = card.children;
scrolled.length = 0;
box.refresh(heading('changed'));
assert.deepEqual([...card.children].slice(0, 2), [button, first]);
assert.equal(card.lastChild, compare);
assert.match(textOf(card), /changed.*words.*as placed/);
assert.deepEqual(scrolled, []);
box.refresh(null);
assert.equal(card.hidden, true);
