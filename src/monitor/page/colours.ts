// Colours of robots and lines. Each has a contrast of at least 3 : 1 to the light and to the dark map, so that the page
// is read in the sun, and they are told apart with any colour vision.
const kRobots = [
  '#2f7de1',
  '#d05a1b',
  '#178a5e',
  '#d1477a',
  '#9a7400',
  '#7d5bd6',
  '#12808e',
  '#8c6243',
  '#5f7488',
  '#6f7f24',
];
export const kStranger = '#5f7488';
export const kEdgeColours = {used: '#0d8440', unused: '#b4690e', rejected: '#d92d3a'};

/** The colour of a slot: beyond ten these are darker, beyond twenty of other hues. */
function colourAt(slot: number): string {
  const base = kRobots[slot % kRobots.length];
  if (slot < kRobots.length) return base;
  if (slot < 2 * kRobots.length) return darker(base, 0.45);
  const hue = (slot * 137.508) % 360;
  return fromHue(hue, 0.2 + 0.05 * (slot % 4));
}

const hex = (values: number[]) => '#' + values.map((v) => Math.round(v).toString(16).padStart(2, '0')).join('');

function darker(colour: string, share: number): string {
  return hex([1, 3, 5].map((k) => (1 - share) * parseInt(colour.slice(k, k + 2), 16)));
}

/** HSL with a saturation of 0.7. */
function fromHue(hue: number, lightness: number): string {
  const reach = 0.7 * Math.min(lightness, 1 - lightness);
  const channel = (n: number) => {
    const k = (n + hue / 30) % 12;
    return 255 * (lightness - reach * Math.max(-1, Math.min(k - 3, 9 - k, 1)));
  };
  return hex([channel(0), channel(8), channel(4)]);
}

/**
 * Keeps each robot's colour as long as the page is open, whenever the others are heard. A number at the end of a name
 * selects the colour, so that pages of several robots agree; where another has it the first free one is taken.
 */
export class RobotColours {
  private slots = new Map<string, number>();
  private colours = new Map<string, string>();

  /** Colours of these robots and of all that were named before. */
  of(robots: string[]): ReadonlyMap<string, string> {
    for (const robot of robots) {
      if (this.slots.has(robot)) continue;
      const slot = this.freeSlot(robot);
      this.slots.set(robot, slot);
      this.colours.set(robot, colourAt(slot));
    }
    return this.colours;
  }

  private freeSlot(robot: string): number {
    const taken = new Set(this.slots.values());
    const number = Number(robot.match(/\d+$/)?.[0] ?? 0);
    if (number >= 1 && number <= 2 * kRobots.length && !taken.has(number - 1)) return number - 1;
    let slot = 0;
    while (taken.has(slot)) ++slot;
    return slot;
  }
}
