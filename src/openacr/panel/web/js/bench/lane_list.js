// Which lanes of the timeline are shown, and where: groups that fold, lanes that are pinned, moved, filtered, and what
// differs between two branches. No element is touched.

/**
 * @typedef {[number, number]} Span first tick, and the one after the last
 * @typedef {{ id: string, kind: string, name: string, card?: string, spans: Span[], on: number, changes: number, flag?: number | null,
 *   packets?: number, lines?: number, slices?: [number, number][] }} Lane
 * @typedef {{ folded?: string[], pinned?: string[], order?: string[], filter?: string }} Arrangement
 * @typedef {{ group: string, count: number, isFolded: boolean }} Heading
 * @typedef {{ lane: Lane }} Row
 */

/** The groups in their order, with the kinds of their lanes. @type {Record<string, string[]>} */
export const GROUPS = {
  pinned: [],
  part: ["part"],
  axes: ["axis"],
  masters: ["master", "hold"],
  programs: ["program", "pause"],
  plcs: ["plc"],
  drives: ["drive"],
  alarms: ["kill"],
  io: ["input", "output"],
  hosts: ["host"],
  sent: ["sent"],
};

/** Whether a lane is bytes on a stream, not a state. @param {Lane} lane */
export const isTraffic = ({ kind }) => kind === "host" || kind === "sent";

/** @param {string} kind */
export const groupOf = (kind) => Object.keys(GROUPS).find((group) => GROUPS[group].includes(kind)) ?? "hosts";

/**
 * The lanes of an answer of the server, those of hosts included, in both directions.
 * @param {any} answer
 * @returns {Lane[]}
 */
export function lanesOf({ lanes, hosts, sent }) {
  const traffic = (/** @type {string} */ kind, /** @type {any} */ each) => ({
    ...each,
    id: `${kind} ${each.stream}`,
    kind,
    name: `${each.is_own ? "PANEL " : ""}STREAM${each.stream}`,
    on: 0,
    changes: each.packets + each.lines,
  });
  return [
    ...lanes.map((/** @type {any} */ each) => ({ ...each, id: `${each.kind} ${each.number}` })),
    ...hosts.map((/** @type {any} */ each) => traffic("host", each)),
    ...sent.map((/** @type {any} */ each) => traffic("sent", each)),
  ];
}

/**
 * Headings and lanes in the order in which they are shown.
 * @param {Lane[]} lanes
 * @param {Arrangement} arrangement
 * @param {(lane: Lane) => string} labelOf
 * @returns {(Heading | Row)[]}
 */
export function arranged(lanes, { folded = [], pinned = [], order = [], filter = "" }, labelOf) {
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  const chosen = lanes.filter((lane) =>
    words.every((word) => `${labelOf(lane)} ${lane.card ?? ""}`.toLowerCase().includes(word)),
  );
  const place = (/** @type {Lane} */ lane) => (order.includes(lane.id) ? order.indexOf(lane.id) : order.length);
  return Object.keys(GROUPS).flatMap((group) => {
    const own =
      group === "pinned"
        ? pinned.flatMap((id) => chosen.find((lane) => lane.id === id) ?? [])
        : chosen
            .filter((lane) => groupOf(lane.kind) === group && !pinned.includes(lane.id))
            .sort((a, b) => place(a) - place(b));
    const isFolded = folded.includes(group);
    return own.length
      ? [{ group, count: own.length, isFolded }, ...(isFolded ? [] : own.map((lane) => ({ lane })))]
      : [];
  });
}

/**
 * A value that is in a list, out of it, or the other way round.
 * @param {string[]} list
 * @param {string} value
 */
export const toggled = (list, value) =>
  list.includes(value) ? list.filter((each) => each !== value) : [...list, value];

/**
 * The order in which a lane has changed its place with its neighbour; as before at the end of its group.
 * @param {string[]} ids of its group as they are shown
 * @param {string} id
 * @param {number} by -1 or 1
 */
export function movedBy(ids, id, by) {
  const [from, to] = [ids.indexOf(id), ids.indexOf(id) + by];
  if (from < 0 || to < 0 || to >= ids.length) return ids;
  const next = [...ids];
  [next[from], next[to]] = [next[to], next[from]];
  return next;
}

/**
 * Where exactly one of two lanes is on.
 * @param {Span[]} one
 * @param {Span[]} other
 * @returns {Span[]}
 */
export function differences(one, other) {
  const edges = [...one, ...other].flat().sort((a, b) => a - b);
  /** @type {Span[]} */
  const found = [];
  for (let place = 0; place + 1 < edges.length; place += 2)
    if (edges[place + 1] > edges[place]) found.push([edges[place], edges[place + 1]]);
  return found;
}

/**
 * The span of a lane at a tick.
 * @param {Span[]} spans in their order
 * @param {number} tick
 * @returns {Span | undefined}
 */
export function spanAt(spans, tick) {
  return spans.find(([from, to]) => tick >= from && tick < to);
}

/**
 * The last of some entries with a tick that is not after a tick.
 * @template {[number, ...any[]]} T
 * @param {T[]} entries in their order
 * @param {number} tick
 * @returns {T | undefined}
 */
export function lastBefore(entries, tick) {
  let [low, high] = [0, entries.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (entries[middle][0] <= tick) low = middle + 1;
    else high = middle;
  }
  return entries[low - 1];
}
