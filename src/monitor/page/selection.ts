import type {CardBox} from './card_box';
import {edgeCard, nodeCard, pointCard, stepCard} from './cards';
import {type Edge, edgeIn} from './edges';
import type {Hit} from './hit';
import type {FleetMap} from './map';
import type {State} from './model';
import type {PairView} from './pair_view';

/** The node, edge, point or step of a trajectory that is selected on the map or in a list, and its card. */
export class Selection {
  private hit?: Hit;

  constructor(
    private card: CardBox,
    private map: FleetMap | undefined,
    private pairView: PairView | undefined,
    private markRegistration: (index: number) => void,
  ) {}

  get node(): string | undefined {
    return this.hit && 'node' in this.hit ? this.hit.node : undefined;
  }

  /** `fromList`: it may be out of the view, so the map moves to it. */
  select(state: State | undefined, hit: Hit | undefined, fromList = false): void {
    this.hit = hit;
    this.map?.select(hit);
    this.pairView?.end();
    if (!hit || !state) return this.card.show(null);
    if ('edge' in hit && hit.edge.registration !== undefined) this.markRegistration(hit.edge.registration);
    const both = 'edge' in hit ? this.pairView?.buttons(state, hit.edge) : undefined;
    const content = this.content(state, hit);
    this.card.show(content && both ? [...content, both] : content, fromList);
    if (fromList) this.goTo(hit);
  }

  /** Shows what a newer state has of it. */
  refresh(before: State | undefined, state: State): void {
    if (!this.hit || !before) return;
    if ('node' in this.hit) return this.card.refresh(this.content(state, this.hit));
    const edge = edgeIn(state, before, this.hit.edge);
    if (!edge) return this.select(state, undefined);
    this.hit = {edge};
    this.map?.select(this.hit);
    this.card.refresh(this.content(state, this.hit));
  }

  private content(state: State, hit: Hit): HTMLElement[] | null {
    if ('node' in hit) {
      if (hit.point) return pointCard(state, hit.node, hit.point);
      const [p, next] = [hit.node, hit.next].map((id) => (id === undefined ? undefined : this.map?.place(id)));
      if (hit.next !== undefined) return stepCard(state, hit.node, hit.next, p && next?.distanceTo(p));
      return nodeCard(state, hit.node, p);
    }
    const [a, b] = this.places(hit.edge);
    return edgeCard(state, hit.edge, a && b?.distanceTo(a));
  }

  private places({a, b}: Edge) {
    return [this.map?.place(a), this.map?.place(b)];
  }

  private goTo(hit: Hit): void {
    const [a, b] = 'node' in hit ? [this.map?.place(hit.node), this.map?.place(hit.node)] : this.places(hit.edge);
    if (a && b) this.map?.eye.goTo(a.clone().add(b).multiplyScalar(0.5));
  }
}
