// EXIT: leave the screens, or end the controller program. Nothing is left moving unattended.
import { give, link, model } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ask } from "../frame/dialog.js";

/** Ask what EXIT means now; what moves is brought to rest first, unless another operator attends it. */
export async function exit() {
  const { holder, you } = model.control.value;
  const isAttended = Boolean(holder) && !you;
  const mustStop = model.state.value.busy && !isAttended;
  const mayEnd = model.hello.value.local && model.may("operate") && !isAttended;
  const text = mustStop ? t("exit.busy") : mayEnd ? t("exit.text") : t("exit.remote");
  const chosen = await ask({
    title: t("menu.exit"),
    body: [h("p", {}, text)],
    choices: [
      { text: t("key.cancel"), value: null },
      { text: t("exit.leave"), value: "leave", kind: mayEnd ? undefined : "bad" },
      ...(mayEnd
        ? [/** @type {import("../frame/dialog.js").Choice} */ ({ text: t("exit.end"), value: "end", kind: "bad" })]
        : []),
    ],
  });
  if (!chosen || (mustStop && !(await broughtToRest()))) return;
  if (chosen === "end" && !(await give("app.end"))) return;
  link.isEnded = true;
  await link.command("control.release").catch(() => {});
  link.socket?.close();
  const again = h("button.key.main", { onclick: () => window.location.reload() }, t("exit.again"));
  document.body.replaceChildren(
    h(
      "main.left",
      {},
      h("h1", {}, "AcroMill"),
      h("p", {}, t(chosen === "end" ? "exit.ended" : "exit.done")),
      chosen === "end" ? "" : again,
    ),
  );
}

/** Stop everything and wait for rest; false when the stop is refused or the link is lost meanwhile. */
async function broughtToRest() {
  if (!(await give("stop.all"))) return false;
  return /** @type {Promise<boolean>} */ (
    new Promise((resolve) => {
      const ends = [
        model.state.watch(({ busy }) => busy || end(true)),
        link.isOpen.watch((isOpen) => isOpen || end(false)),
      ];
      function end(/** @type {boolean} */ isAtRest) {
        queueMicrotask(() => ends.forEach((each) => each()));
        resolve(isAtRest);
      }
    })
  );
}
