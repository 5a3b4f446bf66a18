// MEMORY CONFIG: what is free and how the memory of the card is divided.
import { queryScreen } from "../frame/query_screen.js";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = queryScreen(["MEM", "DIM"], "memory.title");
