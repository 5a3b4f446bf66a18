// FAST STATUS: the copies that the card keeps for fast readers.
import { factsScreen } from "../frame/facts_screen.js";

export const screen = factsScreen("card/fast", "fast.title");
