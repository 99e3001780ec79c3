import {el} from './dom';

/** A table of the Radio panel with its title; a phone scrolls it sideways. `none`: what to say without a row. */
export function radioTable(
  title: string,
  columns: string[],
  rows: string[][],
  name: string,
  none = 'None now.',
): HTMLElement[] {
  const head = el('tr', {}, ...columns.map((column) => el('th', {scope: 'col'}, column)));
  const body = rows.map((row) =>
    el('tr', {}, el('th', {scope: 'row'}, row[0]), ...row.slice(1).map((cell) => el('td', {}, cell))),
  );
  const content =
    rows.length > 0
      ? el('table', {class: 'plain', 'aria-label': title}, el('thead', {}, head), el('tbody', {}, ...body))
      : el('p', {class: 'hint'}, none);
  return [
    el('h2', {}, title),
    el('div', {class: 'scroll', tabindex: '0', role: 'region', 'aria-label': title, 'data-of': name}, content),
  ];
}
