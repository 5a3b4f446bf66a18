// The parts of the operator's screen in the order in which the tour shows them.

/** @type {[string, import("../core/texts.js").Said][]} selector and text */
export const STEPS = [
  [".top .state", "tour.state"],
  ["#status", "tour.status"],
  ["#display", "tour.display"],
  ["#prompt", "tour.prompt"],
  ["#menu", "tour.menu"],
  ["#stop .stop-key", "tour.stop"],
];
