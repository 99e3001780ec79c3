import {colourOf, type State} from './model';

export type Child = Node | string | null | undefined | false;

export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === 'style') element.style.cssText = value;
    else element.setAttribute(name, value);
  }
  for (const child of children) if (child) element.append(child);
  return element;
}

export const dot = (state: State, robot: string) =>
  el('i', {class: 'dot', style: `background:${colourOf(state, robot)}`, 'aria-hidden': 'true'});

/** Choices in a panel that the rest of the page follows. */
export interface Actions {
  selectNode(id: string): void;
  selectRegistration(index: number): void;
}
