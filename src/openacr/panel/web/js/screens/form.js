// One form of the server as a screen.
import { showForm } from "../frame/form.js";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Parameters", de: "Parameter" },
  show({ body, args, endings, setTitle, beforeClose }) {
    beforeClose(showForm(body, args.form, endings, setTitle));
  },
};
