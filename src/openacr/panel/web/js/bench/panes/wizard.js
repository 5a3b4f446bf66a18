// The configuration wizard: dialogs on the left, the code they make on the right; code becomes answers again.
import { get, latest, send } from "../../core/api.js";
import { refuse, report } from "../../core/app.js";
import { fill, h } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { Endings } from "../../core/signal.js";
import { loadSettingTexts, settingText } from "../../core/settings_texts.js";
import { t } from "../../core/texts.js";
import { changed, valueAt, whereOf, withOneMore } from "../wizard/answers.js";
import { formOf } from "../wizard/form.js";

const TEXTS = {
  dialogs: { en: "Dialogs", de: "Dialoge" },
  card: { en: "Card", de: "Karte" },
  ofAxis: { en: "Axis {number}: {name}", de: "Achse {number}: {name}" },
  ofMaster: { en: "Master {number}", de: "Master {number}" },
  axis: { en: "ADD AXIS", de: "ACHSE DAZU" },
  master: { en: "ADD MASTER", de: "MASTER DAZU" },
  remove: { en: "REMOVE {name}", de: "{name} ENTFERNEN" },
  open: { en: "OPEN FILE \u2026", de: "DATEI \u00d6FFNEN \u2026" },
  new: { en: "NEW", de: "NEU" },
  read: { en: "Answers were read from {name}", de: "Antworten aus {name} gelesen" },
  download: { en: "DOWNLOAD {name}", de: "{name} LADEN" },
  wrong: { en: "wrong", de: "falsch" },
};

const REMARK = / : REM (.*)$/;

/**
 * @typedef {import("../wizard/answers.js").Dialog} Dialog
 * @typedef {import("../wizard/answers.js").Answers} Answers
 * @typedef {{ errors: { where: (string | number)[], text: string }[], warnings?: string[],
 *   files?: Record<string, string> }} Code
 */

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep }) {
  /** @type {{ dialogs: Dialog[], answers: Answers }} */
  const { dialogs, answers: first } = (await Promise.all([get("configure"), loadSettingTexts()]))[0];
  let answers = /** @type {Answers} */ (kept.answers ?? first);
  let chosen = { dialog: dialogs[0], place: 0 };
  let file = "setup.8k";
  /** @type {string[]} */
  let notes = [];
  /** @type {Code} */
  let code = { errors: [] };
  const endings = new Endings();
  const newest = latest(endings);
  const nav = h("nav.list.scroll.wizard-nav", { ariaLabel: t(TEXTS.dialogs) });
  const form = h("div.scroll.wizard-dialog", {});
  const output = h("div.stack.wizard-code", {});
  const input = h("input", {
    type: "file",
    hidden: true,
    ariaLabel: t(TEXTS.open),
    accept: ".8k,.toml,.txt",
    onchange: () => void open(),
  });
  head.append(
    keyOf(TEXTS.axis, () => more("axis")),
    keyOf(TEXTS.master, () => more("master")),
    keyOf(TEXTS.open, () => input.click()),
    input,
    keyOf(TEXTS.new, () => take(first)),
  );
  host.append(h("div.wizard", {}, nav, form, output));

  /**
   * Take other answers, keep them, and ask for their code.
   * @param {Answers} now
   * @param {string[]} [remarks]
   */
  async function take(now, remarks = []) {
    answers = now;
    notes = remarks;
    keep({ answers });
    draw();
    const made = await newest(send("POST", "configure/code", { answers })).catch((error) => void refuse(error));
    if (!made) return;
    code = made;
    draw();
  }

  /** @param {"axis" | "master"} what */
  function more(what) {
    const now = withOneMore(answers, what);
    chosen = { dialog: dialogOf(what), place: (now[what] ?? []).length - 1 };
    void take(now);
  }

  /** @param {string} name */
  function dialogOf(name) {
    return dialogs.find((each) => each.name === name) ?? dialogs[0];
  }

  /** Read answers from a file: configure.toml, or set-up code. */
  async function open() {
    const [picked] = input.files ?? [];
    input.value = "";
    if (!picked) return;
    try {
      const body = { name: picked.name, text: await picked.text(), model: answers.card?.model };
      const found = await send("POST", "configure/read", body);
      chosen = { dialog: dialogs[0], place: 0 };
      await take(found.answers, found.notes);
      report(t(TEXTS.read, { name: picked.name }));
    } catch (error) {
      refuse(error);
    }
  }

  function draw() {
    const count = chosen.dialog.of === "card" ? 1 : (answers[chosen.dialog.of] ?? []).length;
    if (chosen.place >= count) chosen = { dialog: dialogs[0], place: 0 };
    const focused =
      document.activeElement instanceof HTMLElement && host.contains(document.activeElement)
        ? document.activeElement.id
        : "";
    fill(nav, ...groups());
    const where = whereOf(chosen.dialog, chosen.place);
    const refusals = Object.fromEntries(
      code.errors.filter((each) => isWithin(each.where, where)).map((each) => [each.where[where.length], each.text]),
    );
    fill(
      form,
      formOf(
        chosen.dialog,
        valueAt(answers, where) ?? {},
        refusals,
        (key, value) => void take(changed(answers, [...where, key], value), notes),
      ),
      ...(chosen.dialog.of === "card"
        ? []
        : [
            h(
              "button.key.bad",
              { type: "button", onclick: () => remove() },
              t(TEXTS.remove, { name: titleOf(chosen.dialog.of, chosen.place) }),
            ),
          ]),
    );
    drawCode();
    if (focused) document.getElementById(focused)?.focus();
  }

  function remove() {
    const what = chosen.dialog.of;
    if (what !== "card")
      void take({ ...answers, [what]: (answers[what] ?? []).filter((_each, n) => n !== chosen.place) });
  }

  /** The dialogs: those of the card, of each axis and of each master. */
  function groups() {
    return /** @type {const} */ (["card", "axis", "master"]).flatMap((of) => {
      const places = of === "card" ? [0] : (answers[of] ?? []).map((_each, n) => n);
      return places.flatMap((place) => [
        h("h3.wizard-title", {}, titleOf(of, place)),
        ...dialogs.filter((each) => each.of === of).map((dialog) => itemOf(dialog, place)),
      ]);
    });
  }

  /**
   * @param {Dialog} dialog
   * @param {number} place
   */
  function itemOf(dialog, place) {
    const isChosen = chosen.dialog === dialog && chosen.place === place;
    const where = whereOf(dialog, place);
    const isWrong = code.errors.some(
      (each) => isWithin(each.where, where) && dialog.rows.some((row) => row.key === each.where[where.length]),
    );
    return h(
      "button.item",
      {
        id: `wizard-${where.join("-")}`,
        type: "button",
        attr: { "aria-current": String(isChosen) },
        onclick: () => {
          chosen = { dialog, place };
          draw();
        },
      },
      h("span.name", {}, settingText(dialog.title)),
      isWrong ? h("span.bad-text", { ariaLabel: t(TEXTS.wrong) }, "\u26a0") : "",
    );
  }

  /**
   * @param {"card" | "axis" | "master"} of
   * @param {number} place
   */
  function titleOf(of, place) {
    if (of === "card") return t(TEXTS.card);
    const table = (answers[of] ?? [])[place] ?? {};
    return of === "axis"
      ? t(TEXTS.ofAxis, { name: table.name ?? "?", number: table.number ?? "?" })
      : t(TEXTS.ofMaster, { number: table.number ?? "?" });
  }

  function drawCode() {
    const files = code.files ?? {};
    if (!(file in files)) file = "setup.8k";
    const lines = (files[file] ?? "").split("\n");
    const link = h(
      "a.key",
      {
        role: "button",
        href: `data:text/plain;charset=utf-8,${encodeURIComponent(files[file] ?? "")}`,
        download: file,
      },
      t(TEXTS.download, { name: file }),
    );
    fill(
      output,
      ...code.errors.map(({ where: [of, place], text }) =>
        h("p.notice.bad", {}, `${titleOf(/** @type {any} */ (of), Number(place))}, ${text}`),
      ),
      ...[...(code.warnings ?? []), ...notes].map((text) => h("p.notice", {}, text)),
      ...(code.files
        ? [
            h(
              "div.row.wrap",
              {},
              h(
                "div.row.wrap.grow",
                { role: "tablist" },
                ...Object.keys(files).map((name) =>
                  h(
                    "button.key",
                    {
                      type: "button",
                      role: "tab",
                      attr: { "aria-selected": String(name === file) },
                      onclick: () => {
                        file = name;
                        drawCode();
                      },
                    },
                    name,
                  ),
                ),
              ),
              link,
            ),
            h(
              "pre.listing-plain.mono.grow.scroll",
              { tabIndex: 0, role: "region", ariaLabel: file },
              ...lines.map(lineOf),
            ),
          ]
        : []),
    );
  }

  await take(answers);
  return () => endings.end();
}

/**
 * A line of code with its remark set apart.
 * @param {string} line
 */
function lineOf(line) {
  const remark = REMARK.exec(line);
  return h(
    "span.wizard-line",
    {},
    remark ? line.slice(0, remark.index) : line,
    remark ? h("span.quiet", {}, `   ${remark[1]}`) : "",
    "\n",
  );
}

/**
 * @param {(string | number)[]} where
 * @param {(string | number)[]} table
 */
function isWithin(where, table) {
  return where.length > table.length && table.every((key, n) => where[n] === key);
}
