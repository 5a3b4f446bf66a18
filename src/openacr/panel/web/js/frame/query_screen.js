// Screens that show what the card answers to a command, asked again while they are open.
import { CommandError } from "../core/link.js";
import { link, refuse } from "../core/app.js";
import { h, setText } from "../core/dom.js";

const EVERY_MS = 1000;

/**
 * @param {string[]} lines commands of the card that only read
 * @param {import("../core/texts.js").TextKey} title
 * @returns {import("./screen_host.js").Screen}
 */
export function queryScreen(lines, title) {
  return {
    title,
    area: "full",
    async show({ body, endings }) {
      const places = lines.map((line) => ({ line, text: h("pre.listing-plain.mono.grow", { tabIndex: 0, role: "region", ariaLabel: line }) }));
      body.append(...places.map(({ text }) => text));
      const ask = async () => {
        try {
          for (const { line, text } of places) setText(text, (await link.command("card.query", { line })).lines.join("\n"));
        } catch (error) {
          if (!(error instanceof CommandError)) throw error;
          refuse(error);
        }
      };
      await ask();
      const timer = setInterval(ask, EVERY_MS);
      endings.add(() => clearInterval(timer));
    },
  };
}
