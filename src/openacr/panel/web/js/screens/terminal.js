// TERMINAL: the direct line to the card, with its control keys.
import { mount } from "../panes/terminal.js";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "terminal.title",
  area: "full",
  async show({ body, head, endings }) {
    endings.add(await mount(body, { head, number: 1 }));
    body.querySelector("form input")?.setAttribute("autofocus", ""); // where a screen begins
  },
};
