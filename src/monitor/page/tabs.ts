/**
 * Joins tabs, each of which controls a panel, as WAI-ARIA has them: one is selected, arrow keys go to the next one that
 * is not hidden. `opened` is called after each change.
 */
export function joinTabs(tabs: HTMLElement[], opened: () => void): void {
  const open = (tab: HTMLElement) => {
    for (const one of tabs) {
      one.setAttribute('aria-selected', String(one === tab));
      one.tabIndex = one === tab ? 0 : -1;
      document.getElementById(one.getAttribute('aria-controls')!)!.hidden = one !== tab;
    }
    opened();
  };
  for (const tab of tabs) {
    tab.onclick = () => open(tab);
    tab.onkeydown = (event) => {
      if (event.key !== 'ArrowLeft' && event.key !== 'ArrowRight') return;
      const shown = tabs.filter((one) => !one.hidden),
        step = event.key === 'ArrowRight' ? 1 : shown.length - 1;
      const next = shown[(shown.indexOf(tab) + step) % shown.length];
      open(next);
      next.focus();
    };
  }
}
