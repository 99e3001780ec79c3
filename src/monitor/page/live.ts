import type {Live, State} from './model';

export interface Listener {
  onState(state: State): void;
  onLive(live: Live): void;
  onConnection(connected: boolean): void;
}

/** Follows the program's state and live status; tries again where the connection is lost. */
export function follow(listener: Listener): void {
  let wait = 500;
  const open = () => {
    const socket = new WebSocket(`ws://${location.host}/live`);
    socket.onmessage = (message) => {
      wait = 500;
      const content = JSON.parse(message.data as string) as Partial<State> & {live?: Live};
      if (content.live) {
        listener.onConnection(true);
        listener.onLive(content.live);
      } else if (content.nodes) {
        // else nothing was published yet
        listener.onConnection(true);
        listener.onState(content as State);
      }
    };
    socket.onclose = () => {
      listener.onConnection(false);
      setTimeout(open, wait);
      wait = Math.min(2 * wait, 10_000);
    };
  };
  open();
}
