// Brings elements up to date in place, so that focus, open menus and scrolling stay, and a screen reader does not read
// again what has not changed.

import {setAttribute, unbroken} from './dom';

const isElement = (node: Node): node is HTMLElement => node.nodeType === 1;
const keyOf = (node: Node) => (isElement(node) ? node.id || node.getAttribute('data-key') || '' : '');

export function setText(element: Element, text: string): void {
  const shown = unbroken(text);
  if (element.textContent !== shown) element.textContent = shown;
}

/**
 * Makes `next` the children of an element. A child that is there already stays and is changed where it differs: one
 * with the same id or data-key, else the one in its place if that is of the same kind.
 */
export function patch(parent: Element, next: readonly Node[]): void {
  const there = new Map<string, Node>();
  for (const child of parent.childNodes) if (keyOf(child)) there.set(keyOf(child), child);
  const wanted = new Set<Node>(next);
  for (const one of next) {
    const known = there.get(keyOf(one));
    if (known) wanted.add(known);
  }
  let at = parent.firstChild;
  for (const one of next) {
    while (at && keyOf(at) && !wanted.has(at)) at = removed(at);
    const known = parent === one.parentNode ? one : keyOf(one) ? there.get(keyOf(one)) : counterpart(at, one, wanted);
    if (!known || (known !== one && !isAlike(known, one))) {
      parent.insertBefore(one, at);
      continue;
    }
    if (known === at) at = at.nextSibling;
    else parent.insertBefore(known, at);
    if (known !== one) update(known, one);
  }
  while (at) at = removed(at);
}

function removed(node: ChildNode): ChildNode | null {
  const after = node.nextSibling;
  node.remove();
  return after;
}

const isAlike = (a: Node, b: Node) => a.nodeName === b.nodeName;

/** The child in the place of `one`, if it may become that. */
function counterpart(at: ChildNode | null, one: Node, wanted: ReadonlySet<Node>): ChildNode | undefined {
  return at && !keyOf(at) && !wanted.has(at) && isAlike(at, one) ? at : undefined;
}

function update(known: Node, next: Node): void {
  if (!isElement(known) || !isElement(next)) {
    if (known.textContent !== next.textContent) known.textContent = next.textContent;
    return;
  }
  for (const {name} of [...known.attributes]) if (!next.hasAttribute(name)) known.removeAttribute(name);
  for (const {name, value} of next.attributes) if (known.getAttribute(name) !== value) setAttribute(known, name, value);
  known.onclick = next.onclick;
  known.onchange = next.onchange;
  patch(known, [...next.childNodes]);
  if (known.nodeName !== 'SELECT') return;
  const menu = known as HTMLElement as HTMLSelectElement,
    {value} = next as HTMLElement as HTMLSelectElement;
  if (menu.value !== value) menu.value = value;
}
