import {type Alignment, registrationKeys, type State} from './model';

/** A line between two nodes: an alignment, or a registration that gave none. */
export interface Edge {
  kind: 'used' | 'unused' | 'rejected';
  a: string;
  b: string;
  registration?: number; // index in State.registrations
  alignment?: number; // index in State.alignments
}

const kindOf = (alignment: Alignment) => (alignment.status === 'used' ? 'used' : 'unused');

/** Alignments, each with the registration that it came of, and the registrations that were rejected. */
export function edgesOf(state: State): Edge[] {
  const registrations = new Map<number, number>();
  state.registrations.forEach(({alignment}, k) => alignment !== null && registrations.set(alignment, k));
  const edges: Edge[] = state.alignments.map((alignment, k) => ({
    kind: kindOf(alignment),
    a: alignment.i,
    b: alignment.j,
    alignment: k,
    registration: registrations.get(k),
  }));
  state.registrations.forEach(({verdict}, k) => {
    if (verdict === 'rejected' || verdict === 'failed') edges.push(edgeOfRegistration(state, k));
  });
  return edges;
}

/** The edge of registration number `k`, whether the map shows one for it or not. */
export function edgeOfRegistration(state: State, k: number): Edge {
  const {alignment, verdict, target, source} = state.registrations[k];
  const edge = {a: target, b: source, registration: k};
  if (alignment !== null) return {...edge, kind: kindOf(state.alignments[alignment]), alignment};
  return {...edge, kind: verdict === 'rejected' || verdict === 'failed' ? 'rejected' : 'unused'};
}

/** The edge of an earlier state in a newer one, whose lists may have grown anywhere; undefined: it is gone. */
export function edgeIn(state: State, before: State, edge: Edge): Edge | undefined {
  if (edge.registration !== undefined) {
    const k = registrationKeys(state).indexOf(registrationKeys(before)[edge.registration]);
    return k < 0 ? undefined : edgeOfRegistration(state, k);
  }
  if (edge.alignment === undefined) return edge;
  const same = ({i, j, by}: Alignment) => i === edge.a && j === edge.b && by === before.alignments[edge.alignment!].by;
  const index = before.alignments.slice(0, edge.alignment).filter(same).length; // among those of the same nodes
  const there = edgesOf(state).filter((one) => one.alignment !== undefined && same(state.alignments[one.alignment]));
  return there[index];
}
