// Chains of joints: where their links are amid a move. Poses are twelve numbers, by rows.

import { plus, times, turned, unit } from "./vectors.js";

/**
 * @typedef {{name: string, parent: ?number, origin: number[], joint: string, axis: number[], variable: number,
 *   meshes: {mesh: number, pose: number[]}[]}} Link  origin: parent from joint; pose: link from mesh
 * @typedef {{links: Link[]}} Chain
 * @typedef {{chain: number, from: number[], to: number[], base: number[]}} Move
 */

const column = (pose, k) => [pose[k], pose[4 + k], pose[8 + k]];
const fromColumns = (columns) => [0, 1, 2].flatMap((row) => columns.map((one) => one[row]));
const turnedBy = (pose, vector) => [0, 1, 2].map((row) => [0, 1, 2].reduce((sum, k) => sum + pose[4 * row + k] * vector[k], 0));

/** A point, placed. */
export const placedBy = (pose, point) => plus(turnedBy(pose, point), column(pose, 3));
/** Places by `inner`, then by `outer`. */
export const product = (outer, inner) =>
  fromColumns([...[0, 1, 2].map((k) => turnedBy(outer, column(inner, k))), placedBy(outer, column(inner, 3))]);

function jointPose({ joint, axis }, number) {
  const longest = Math.max(...axis.map(Math.abs)) || 1, along = unit(axis.map((x) => x / longest));
  const turn = { axis, angle: joint === "revolute" ? number : 0 };
  const columns = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((one) => turned(turn, one, 1));
  return fromColumns([...columns, joint === "prismatic" ? times(number, along) : [0, 0, 0]]);
}

/**
 * World from a link's frame, at a part of a move.
 * @param {Chain} chain
 * @param {Move} move
 */
export function linkPose(chain, move, share, /** @type {number} */ number) {
  const link = chain.links[number], { parent, variable } = link;
  const root = product(parent === null ? move.base : linkPose(chain, move, share, parent), link.origin);
  if (link.joint === "fixed") return root;
  return product(root, jointPose(link, move.from[variable] + share * (move.to[variable] - move.from[variable])));
}

/**
 * The links' meshes, by link.
 * @param {Chain} chain
 */
export const bodiesOf = (chain) =>
  chain.links.flatMap(({ meshes }, link) => meshes.map(({ mesh, pose }, number) => ({ link, number, mesh, pose })));

/**
 * How many lines show the way of a link: several for each radian.
 * @param {Chain} chain
 * @param {Move} move
 */
export function partsOf(chain, { from, to }, share) {
  const angles = chain.links.map(({ joint, variable }) => (joint === "revolute" ? Math.abs(to[variable] - from[variable]) : 0));
  return Math.min(Math.max(2, Math.ceil(5 * share * angles.reduce((sum, angle) => sum + angle, 0))), 400);
}
