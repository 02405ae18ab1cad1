// What colours and signs mean.

import { plus, times } from "./vectors.js";

export const COLOURS = {
  hit: [0.9, 0.42, 0.05], clear: [0.1, 0.6, 0.47], overlap: [0.85, 0.13, 0.5], undecided: [0.85, 0.65, 0],
  invalid: [0.35, 0.35, 0.35], object: [0.68, 0.72, 0.78], touched: [0.32, 0.55, 0.86], listed: [0.5, 0.72, 0.86],
  triangle: [1, 0.9, 0.1], normal: [0.05, 0.2, 0.75], gap: [0.75, 0.1, 0.1], path: [0.15, 0.15, 0.2],
};
COLOURS.part = COLOURS.overlap;
export const SYMBOLS = { hit: "●", clear: "○", part: "○", overlap: "✕", undecided: "◆", invalid: "–" };
export const MARKS = { hit: "disc", clear: "ring", part: "ring", overlap: "cross", undecided: "diamond", invalid: "square" };

// The viridis map (S. van der Walt and N. Smith, 2015), as a polynomial (M. Zucker).
const VIRIDIS = [
  [0.2777, 0.0054, 0.3341], [0.1051, 1.4046, 1.3846], [-0.3309, 0.2148, 0.0951], [-4.6342, -5.7991, -19.3324],
  [6.2283, 14.1799, 56.6906], [4.7764, -13.7451, -65.353], [-5.4355, 4.6459, 26.3124],
];
export function viridis(share) {
  const x = Math.min(Math.max(share, 0), 1);
  const colour = VIRIDIS.reduceRight((sum, factors) => plus(times(x, sum), factors), [0, 0, 0]);
  return colour.map((value) => Math.min(Math.max(value, 0), 1));
}

/** A colour of its own for each number. */
export function hashed(number) {
  const hue = (number * 0.618034) % 1;
  return [0, 1 / 3, 2 / 3].map((shift) => 0.45 + 0.4 * Math.cos(2 * Math.PI * (hue + shift)));
}
