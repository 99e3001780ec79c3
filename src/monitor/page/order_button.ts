import {el} from './dom';
import {setText} from './patch';

const kWait_ms = 5000; // for the second press

/**
 * A button that orders robots. Where it has a question it orders on the second press within five seconds, so that a
 * slip of a finger orders nothing. It is disabled from an order until the robots' next status, which may call for
 * another one.
 */
export class OrderButton {
  readonly root = el('button', {type: 'button', class: 'order'});
  private askedAt?: number;
  private asked?: string; // the question then
  private pending = false; // ordered, and no newer status
  private text = '';
  private name = '';

  /** `question`: to be confirmed, undefined if the present order needs none; `said`: shows what to do. */
  constructor(
    order: () => Promise<boolean>,
    private question: () => string | undefined,
    private said: (text: string) => void,
  ) {
    this.root.onclick = async () => {
      if (this.asks()) return;
      this.root.disabled = true;
      this.pending = await order();
      this.root.disabled = this.pending;
    };
  }

  /** `name`: for screen readers, where the text alone does not tell which robot. A new text ends the question. */
  label(text: string, name = text): void {
    const isNew = text !== this.text;
    [this.text, this.name] = [text, name];
    if (isNew) this.askedAt = undefined;
    this.refresh();
  }

  /** To be called once a second: the question ends by itself. */
  refresh(): void {
    const question = this.waits() ? this.question() : undefined;
    if (question === undefined || question !== this.asked) this.askedAt = undefined;
    const shown = this.waits() ? question : undefined;
    setText(this.root, shown ?? this.text);
    const name = shown ? `${shown} ${this.name}` : this.name;
    if (name === this.text) this.root.removeAttribute('aria-label');
    else this.root.setAttribute('aria-label', name);
    this.root.classList.toggle('sure', shown !== undefined);
  }

  /** A newer status has come. */
  answered(): void {
    if (this.pending) this.root.disabled = false;
    this.pending = false;
  }

  /** Whether this press only asks. */
  private asks(): boolean {
    const question = this.question();
    const asks = question !== undefined && !(this.waits() && question === this.asked);
    this.askedAt = asks ? performance.now() : undefined;
    this.asked = question;
    this.refresh();
    if (asks) this.said(`Press again within 5 s: ${this.name}.`);
    return asks;
  }

  private waits(): boolean {
    return this.askedAt !== undefined && performance.now() - this.askedAt <= kWait_ms;
  }
}
