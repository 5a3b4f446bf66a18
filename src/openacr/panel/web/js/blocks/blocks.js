// The blocks of the status views by their names in the store.
import { buttonsBlock } from "./buttons.js";
import { estopBlock } from "./estop.js";
import { feedsBlock } from "./feeds.js";
import { modalBlock } from "./modal.js";
import { distanceBlock, nextBlock, positionBlock } from "./positions.js";

/** @type {Record<string, (panel: HTMLElement, endings: import("../core/signal.js").Endings) => void>} */
export const BLOCKS = {
  position: positionBlock,
  distance: distanceBlock,
  next: nextBlock,
  modal: modalBlock,
  estop: estopBlock,
  feeds: feedsBlock,
  buttons: buttonsBlock,
};

export const BLOCK_NAMES = Object.freeze(Object.keys(BLOCKS));
