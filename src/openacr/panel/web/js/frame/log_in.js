// Logging in with a higher role from within the screens: the key that was pressed goes on afterwards.
import { ApiError, send } from "../core/api.js";
import { link, model } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { ROLES } from "../core/model.js";
import { t } from "../core/texts.js";
import { ask } from "./dialog.js";

/**
 * Ask for the password of a role; true once this browser has the role.
 * @param {string} role least role
 */
export async function logIn(role) {
  const roles = ROLES.slice(ROLES.indexOf(role));
  const choice = h(
    "select.field",
    {},
    ...roles.map((each) => h("option", { value: each }, t(/** @type {any} */ (`role.${each}`)))),
  );
  const password = h("input.field", { type: "password", autocomplete: "current-password" });
  const refusal = h("div.refusal", { hidden: true, attr: { "aria-live": "polite" } });
  const check = async () => {
    try {
      await send("POST", "login", { role: choice.value, password: password.value });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      setText(refusal, error.message);
      refusal.hidden = false;
      password.select();
      password.focus();
      return undefined;
    }
    await connectedAgain();
    return true;
  };
  return Boolean(
    await ask({
      title: t("login.title"),
      first: password,
      body: [
        h("label.row", {}, h("span.grow", {}, t("login.role")), choice),
        h("label.row", {}, h("span.grow", {}, t("login.password")), password),
        refusal,
      ],
      choices: [
        { text: t("key.cancel"), value: null },
        { text: t("login.go"), kind: "main", isSubmit: true, value: check },
      ],
    }),
  );
}

/** A connection has the role it was opened with, so another one is opened. */
function connectedAgain() {
  const before = model.hello.value.client;
  return /** @type {Promise<void>} */ (
    new Promise((resolve) => {
      const end = model.hello.watch(({ client }) => {
        if (client === before) return;
        queueMicrotask(() => end());
        resolve();
      });
      link.renew();
    })
  );
}
