import type {State} from './model';

/** Follows the program's state; tries again where the connection is lost. */
export function follow(onState: (state: State) => void, onConnection: (connected: boolean) => void): void {
  let wait = 500;
  const open = () => {
    const socket = new WebSocket(`ws://${location.host}/live`);
    socket.onmessage = (message) => {
      wait = 500;
      const state = JSON.parse(message.data as string) as State;
      if (!state.nodes) return;  // nothing was published yet
      onConnection(true);
      onState(state);
    };
    socket.onclose = () => {
      onConnection(false);
      setTimeout(open, wait);
      wait = Math.min(2 * wait, 10_000);
    };
  };
  open();
}
