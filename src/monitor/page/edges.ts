import type {Registration, State} from './model';

/** A line between two nodes: an alignment, or a registration that was rejected. */
export interface Edge {
  kind: 'used' | 'unused' | 'rejected';
  a: string;
  b: string;
  registration?: number; // index in State.registrations
  alignment?: number; // index in State.alignments
}

/** Alignments, and the registrations that gave none. */
export function edgesOf(state: State): Edge[] {
  const edges: Edge[] = state.alignments.map((alignment, k) => ({
    kind: alignment.status === 'used' ? 'used' : 'unused',
    a: alignment.i,
    b: alignment.j,
    alignment: k,
    registration: registrationOf(state, alignment.i, alignment.j, alignment.by),
  }));
  state.registrations.forEach((one, k) => {
    if (one.verdict === 'rejected' || one.verdict === 'failed')
      edges.push({kind: 'rejected', a: one.target, b: one.source, registration: k});
  });
  return edges;
}

/** The edge of a registration, number `index` of the state's, that the map shows no edge for. */
export function edgeOfRegistration({verdict, target, source}: Registration, index: number): Edge {
  return {kind: verdict === 'accepted' ? 'unused' : 'rejected', a: target, b: source, registration: index};
}

function registrationOf(state: State, target: string, source: string, by: string): number | undefined {
  const k = state.registrations.findIndex(
    (one) =>
      one.target === target &&
      one.source === source &&
      one.by === by &&
      one.verdict !== 'rejected' &&
      one.verdict !== 'failed',
  );
  return k < 0 ? undefined : k;
}
