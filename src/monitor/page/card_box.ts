import {el} from './dom';
import {patch} from './patch';

/**
 * The card of what is selected: over the map, or below it in a narrow window, where it would cover what it describes.
 */
export class CardBox {
  private back?: number; // where the list was read before the page scrolled to the map

  constructor(
    private card: HTMLElement,
    private map: HTMLElement,
    private onClose: () => void,
    private narrow = matchMedia('(max-width: 899px)'),
  ) {}

  /** A narrow window scrolls to the map and the card; closing scrolls back to the list that it came `fromList`. */
  show(content: HTMLElement[] | null, fromList = false): void {
    this.card.hidden = content === null;
    if (!content) return this.card.replaceChildren();
    const close = el('button', {type: 'button', class: 'quiet close', 'aria-label': 'Close', 'data-key': 'close'}, '✕');
    close.onclick = () => {
      this.onClose();
      if (this.back !== undefined) window.scrollTo(0, this.back);
      this.back = undefined;
    };
    this.card.replaceChildren(close, ...content);
    if (!this.narrow.matches) return;
    this.back = fromList ? (this.back ?? window.scrollY) : undefined;
    this.map.scrollIntoView({block: 'start'});
    this.card.scrollIntoView({block: 'nearest'});
  }

  /** Changes the words of the open card in place; what compares two clouds stays as it is. */
  refresh(content: HTMLElement[] | null): void {
    if (!content || this.card.hidden) return this.show(content);
    const stays = [...this.card.children].filter((one) => one.matches('.close, .compare'));
    const [close, ...compare] = stays;
    patch(this.card, [close, ...content, ...compare]);
  }
}
