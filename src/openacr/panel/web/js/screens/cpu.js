// CPU LOAD: how busy the card is.
import { queryScreen } from "../frame/query_screen.js";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = queryScreen(["CPU"], "cpu.title");
