import type {Live, State} from './model';

export interface Listener {
  onState(state: State): void;
  onLive(live: Live): void;
  /** `trouble`: what keeps the newest state from the page, and what to do; empty: nothing does. */
  onConnection(trouble: string): void;
}

const kSilent_ms = 15_000; // a running robot sends its status once a second
const kFirstWait_ms = 500;
const kMaxWait_ms = 10_000;

/** Follows the program's state and live status; tries again where the connection is lost. */
export function follow(listener: Listener): void {
  let wait = kFirstWait_ms;
  const open = () => {
    const socket = new WebSocket(`ws://${location.host}/live`);
    let watch: ReturnType<typeof setTimeout> | undefined,
      heard = false;
    const lost = async () => {
      clearTimeout(watch);
      // A socket whose other end is gone without a word takes minutes to close.
      socket.onclose = socket.onmessage = null;
      socket.close();
      listener.onConnection('The connection is lost; the last state is shown.');
      setTimeout(open, wait);
      wait = Math.min(2 * wait, kMaxWait_ms);
      if (!heard) listener.onConnection(await refusal());
    };
    socket.onmessage = (message) => {
      wait = kFirstWait_ms;
      heard = true;
      try {
        const content = JSON.parse(message.data as string) as Partial<State> & {live?: Live};
        if (content.live) {
          clearTimeout(watch);
          watch = setTimeout(lost, kSilent_ms);
        }
        show(listener, content);
      } catch (error) {
        console.error(error);
        listener.onConnection(`This page cannot show the newest state (${(error as Error).message}); reload it.`);
      }
    };
    socket.onclose = lost;
  };
  open();
}

/** An empty message: nothing was published yet. */
function show(listener: Listener, content: Partial<State> & {live?: Live}): void {
  if (content.live) listener.onLive(content.live);
  else if (content.nodes) listener.onState(content as State);
  else return;
  listener.onConnection('');
}

/** The reason why no connection is opened, which the browser does not tell. */
async function refusal(): Promise<string> {
  try {
    const answer = await fetch('/live');
    if (answer.status === 403 || answer.status === 503)
      return `Refused: ${(await answer.text()).trim()}. This page tries again.`;
    return 'The connection is lost; this page tries again.';
  } catch {
    return 'The program does not answer: is it running, and in reach of this network? This page tries again.';
  }
}
