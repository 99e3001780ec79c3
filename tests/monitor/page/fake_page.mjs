// A page without a browser, for modules that write HTML: linkedom's document, and of the browser what the modules use.
import {pagePackage} from './page_module.mjs';

/** Defines document and its kin globally; `html` is the content of its body. */
export async function openPage(pageFolder, html = '') {
  const {parseHTML} = await pagePackage(pageFolder, 'linkedom/esm/index.js');
  const {window, document} = parseHTML(`<!doctype html><html><body>${html}</body></html>`);
  const elements = Object.getPrototypeOf(Object.getPrototypeOf(document.createElement('div')));
  elements.focus = function focus() {
    document.activeElement = this;
  };
  elements.scrollIntoView = () => {};
  addSelectValue(Object.getPrototypeOf(document.createElement('select')));
  const page = {frames: [], observers: []};
  Object.assign(globalThis, {
    window,
    document,
    Option: class {
      constructor(text, value) {
        const option = document.createElement('option');
        option.setAttribute('value', value);
        option.textContent = text;
        return option;
      }
    },
    getComputedStyle: () => ({getPropertyValue: (name) => name}),
    ResizeObserver: class {
      constructor(act) {
        page.observers.push(act);
      }
      observe() {}
    },
    requestAnimationFrame: (act) => page.frames.push(act),
    setInterval: (act) => page.intervals.push(act),
  });
  page.intervals = [];
  return page;
}

/** Menus have a value, which linkedom leaves out. */
function addSelectValue(prototype) {
  Object.defineProperty(prototype, 'value', {
    configurable: true,
    get() {
      const option = this.querySelector('option[selected]') ?? this.querySelector('option');
      return option?.getAttribute('value') ?? '';
    },
    set(value) {
      for (const one of this.querySelectorAll('option'))
        one.toggleAttribute('selected', one.getAttribute('value') === value);
    },
  });
}

/** The element's text, white space as it is seen. */
export const textOf = (element) => element.textContent.replace(/\s+/g, ' ').trim();
