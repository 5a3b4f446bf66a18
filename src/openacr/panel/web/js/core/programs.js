// What the programs of the card do: one subscription for all panes that show it.
import { link } from "./app.js";
import { Signal } from "./signal.js";

const HZ = 5;
/** The program of the card that was chosen last in a pane, e.g. PROG3. */
export const chosenProgram = new Signal("");
let count = 0;
let end = () => {};

/** Have the states of the programs sent to `model.programs`; returns the function that ends it. */
export function needPrograms() {
  if (count++ === 0) end = link.subscribe({ topic: "programs", hz: HZ });
  let isEnded = false;
  return () => {
    if (isEnded) return;
    isEnded = true;
    if (--count === 0) end();
  };
}

/**
 * The program to show where none was chosen: the first one with a text that is not the machine's, or with room for one.
 * @param {{ name: string, used: number, bytes: number, owner: string }[]} listed
 */
export function firstProgram(listed) {
  const free = listed.filter((each) => !each.owner);
  return (free.find((each) => each.used) ?? free.find((each) => each.bytes))?.name ?? "PROG0";
}
