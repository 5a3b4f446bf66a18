// MEMORY CONFIG: how the memory of the card is divided.
import { factsScreen } from "../frame/facts_screen.js";

export const screen = factsScreen("card/memory", "memory.title");
