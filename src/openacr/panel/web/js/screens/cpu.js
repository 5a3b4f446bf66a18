// CPU LOAD: how busy the card is.
import { factsScreen } from "../frame/facts_screen.js";

export const screen = factsScreen("card/load", "cpu.title");
