import {colourOf, type State} from './model';

export type Child = Node | string | null | undefined | false;

/** Joins numbers with their units, so that no line breaks between them. */
export function unbroken(text: string): string {
  return text.replace(/(\d) (?=%|σ|(?:[kM]?B|[ckm]?m|m?s|min|h|ppm|[kM])(?![\w-]))/g, '$1\u00a0');
}

export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) setAttribute(element, name, value);
  for (const child of children) if (child) element.append(typeof child === 'string' ? unbroken(child) : child);
  return element;
}

/** The page's own security policy refuses a style that is set as an attribute. */
export function setAttribute(element: HTMLElement | SVGElement, name: string, value: string): void {
  if (name === 'style') element.style.cssText = value;
  else element.setAttribute(name, value);
}

export function shape(name: string, attributes: Record<string, string | number>, text = ''): SVGElement {
  const one = document.createElementNS('http://www.w3.org/2000/svg', name) as SVGElement;
  for (const [key, value] of Object.entries(attributes)) setAttribute(one, key, String(value));
  if (text) one.textContent = text;
  return one;
}

export const dot = (state: State, robot: string) =>
  el('i', {class: 'dot', style: `background:${colourOf(state, robot)}`, 'aria-hidden': 'true'});

/** Choices in a panel that the rest of the page follows. */
export interface Actions {
  selectNode(id: string): void;
  selectRegistration(index: number): void;
}
