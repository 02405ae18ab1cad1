// Which part of a scene is to be seen at first: what is far from all the rest would make a dot of it.

import { lengthOf, minus } from "./vectors.js";

// How many times as far as the rest reaches.
const FAR = 30;
// Numbers of WebGL's end at 3e38.
export const LARGEST = 1e30;

/** A box that grows. */
export class Bounds {
  lo = [Infinity, Infinity, Infinity];
  hi = [-Infinity, -Infinity, -Infinity];

  add(place, radius) {
    for (let k = 0; k < 3; ++k) {
      this.lo[k] = Math.min(this.lo[k], place[k] - radius);
      this.hi[k] = Math.max(this.hi[k], place[k] + radius);
    }
  }
  get isEmpty() {
    return !(this.lo[0] <= this.hi[0]);
  }
  get diagonal() {
    return this.isEmpty ? 0 : lengthOf(minus(this.hi, this.lo));
  }
}

/**
 * A ball around something.
 * @typedef {{place: number[], radius: number, isSensor: boolean}} Thing
 */

/**
 * The median of each coordinate.
 * @param {Thing[]} things
 */
function middleOf(things) {
  return [0, 1, 2].map((k) => Float64Array.from(things, ({ place }) => place[k]).sort()[things.length >> 1]);
}

/**
 * Those that are near together, at least half of them; and the far ones.
 * @param {Thing[]} things
 */
export function nearTogether(things) {
  const fits = ({ place, radius }) => Math.max(...place.map(Math.abs), radius) < LARGEST;
  const usable = things.filter(fits), sensors = usable.filter(({ isSensor }) => isSensor);
  const near = [], far = things.filter((thing) => !fits(thing));
  if (usable.length === 0) return { near, far };
  const middle = middleOf(sensors.length ? sensors : usable);
  const distant = usable.map((thing) => ({ thing, distance: lengthOf(minus(thing.place, middle)) - thing.radius }));
  distant.sort((a, b) => a.distance - b.distance);
  let reach = 0, kinds = 0, isFar = false;
  for (const { thing, distance } of distant) {
    isFar ||= 2 * near.length >= usable.length && kinds === (sensors.length ? 3 : 1) && distance > FAR * reach && reach > 0;
    (isFar ? far : near).push(thing);
    reach = Math.max(reach, distance + 2 * thing.radius);
    kinds |= thing.isSensor ? 2 : 1;
  }
  return { near, far };
}
