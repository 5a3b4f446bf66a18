// The top of the main screen: state, alarms and user messages, who has control, appearance.
import { give, model, refuse, report } from "../core/app.js";
import { byId, fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { applyTheme, keepSetting, setting } from "../core/settings.js";
import { LANGUAGES, t, textOr } from "../core/texts.js";
import { PLAIN } from "../draw/colors.js";
import { ask, confirm } from "./dialog.js";

/** @type {Record<string, string>} */
const SIGNS = {
  IDLE: "\u25cb",
  RUN: "\u25b6",
  WAIT: "\u25d4",
  HOMING: "\u2302",
  PAUSED: "\u2016",
  HOLD: "\u25a0",
  ALARM: "\u26a0",
};

const MOST_MESSAGES = 3; // at once in the line; a key shows all of them
const MOST_BESIDE_ALARM = 1;

/** @type {(name: string) => void} */
let show = () => {};

/** @param {(name: string) => void} showTab shows what a key of the top leads to: "alarms" */
export function startTop(showTab) {
  show = showTab;
  model.state.watch(drawState);
  model.lamp.watch(drawState);
  model.alarms.watch(drawAlarms);
  model.messages.watch(drawAlarms);
  model.program.watch(drawAlarms);
  model.timeline.watch(drawAlarms);
  model.moment.watch(drawAlarms);
  model.hello.watch(drawAlarms);
  model.hello.watch(drawTools);
  model.control.watch(drawTools);
}

function drawState() {
  const { state, reason, jogging } = model.state.value;
  const chip = byId("state");
  const { moving, running, drives } = model.lamp.value;
  // What moves or runs on the card without AcroMill.
  const ofCard = state === "IDLE" && !jogging && (moving.length > 0 || running.length > 0);
  const shown = ofCard ? "RUN" : state;
  chip.dataset.state = shown;
  const name =
    state === "PAUSED"
      ? "----PAUSE----"
      : jogging && state === "IDLE"
        ? t("state.JOG")
        : ofCard
          ? t(moving.length ? "lamp.moves" : "lamp.runs")
          : textOr(`state.${state}`, state);
  chip.title = drives.length ? t("lamp.drives", { axes: drives.join(" ") }) : "";
  const detail = ofCard ? [...moving, ...running].join(" ") : reason;
  fill(
    chip,
    h("span.sign", { ariaHidden: "true" }, SIGNS[shown] ?? ""),
    h("span", {}, name),
    detail ? h("span.reason", { title: detail }, detail) : "",
  );
}

/** The first alarm with its keys, then user messages; without any the mode, or the name of the loaded program. */
function drawAlarms() {
  const area = byId("alarms");
  const { active } = model.alarms.value;
  area.classList.toggle("has-alarm", active.length > 0);
  const mode = active.length ? [] : modeParts();
  area.classList.toggle("has-mode", mode.length > 0);
  const messages = model.messages.value.shown.map(messageOf);
  const few = messages.slice(0, active.length ? MOST_BESIDE_ALARM : MOST_MESSAGES);
  const more = messages.length - few.length;
  const loaded = model.program.value.loaded;
  const looks = mode.map((each) => each.textContent).join("|");
  if (mode.length && looks === area.dataset.mode && !messages.length) return; // a key stays under the finger
  area.dataset.mode = looks;
  const none = h("span.none", { title: loaded?.path ?? "" }, loaded ? loaded.name : t("alarm.noprogram"));
  const count = loaded ? loaded.errors || loaded.warnings : 0;
  const found = count
    ? h(
        "button.key",
        {
          type: "button",
          className: loaded?.errors ? "key bad" : "key",
          title: t("findings.title"),
          onclick: async () => (await import("./findings.js")).showFindings(),
        },
        t(loaded?.errors ? "findings.errors" : "findings.warnings", { count }),
      )
    : "";
  fill(
    area,
    ...(active.length ? alarmParts(active) : mode),
    ...few,
    more > 0
      ? h(
          "button.key",
          { type: "button", title: t("message.all"), onclick: showMessages },
          t("message.more", { count: more }),
        )
      : "",
    ...(active.length || messages.length || mode.length ? [] : [none, found]),
  );
}

/** What is unlike a machine that is operated: the card is at a moment of its past, or AcroMill has not set it up. */
function modeParts() {
  const { away, still, period_s: period } = model.timeline.value;
  const { tick, last } = model.moment.value;
  if (away) {
    const text = t("mode.past", { at: (tick * period).toFixed(1), before: ((last - tick) * period).toFixed(1) });
    return [h("span.text", { title: t("mode.past.title") }, text)];
  }
  if (still) return [h("span.text", {}, t("mode.still"))];
  const { lacks } = model.hello.value.machine;
  if (!lacks) return [];
  return [h("span.text", { title: lacks }, lacks), keyOf("mode.setup", () => setUp(lacks))];
}

/** @param {string} lacks */
async function setUp(lacks) {
  if (!(await confirm(t("mode.setup"), `${lacks}. ${t("mode.setup.text")}`, t("mode.setup")))) return;
  if ((await give("card.setup")) !== null) report(t("mode.setup.done"));
}

/** @param {any[]} active */
function alarmParts([first, ...others]) {
  return [
    h("span", { ariaHidden: "true" }, "\u26a0"),
    h("span.text", { title: first.text }, `${first.code} ${first.text}`),
    others.length ? h("span", {}, t("alarm.more", { count: others.length })) : "",
    keyOf("alarm.acknowledge", acknowledge, ".bad"),
    keyOf("alarm.show", () => show("alarms")),
  ];
}

/** Acknowledge the alarms; of those that stay, what has to be done is in the prompt line. */
async function acknowledge() {
  const answer = await give("alarm.acknowledge");
  if (answer?.left.length) refuse(t("alarm.left", { what: answer.left.join("; ") }));
}

/** @param {any} message */
function messageOf(message) {
  const text = h("span.user", { title: message.text }, message.text);
  text.style.background = PLAIN[message.back] ?? "";
  text.style.color = PLAIN[message.color] ?? "";
  return text;
}

function showMessages() {
  const body = model.messages.value.shown.map((each) => h("p", {}, messageOf(each)));
  void ask({ title: t("message.all"), body, choices: [{ text: t("key.close"), value: null }] });
}

function drawTools() {
  const { holder, you, asking } = model.control.value;
  const label = you
    ? t("control.you")
    : holder
      ? t("control.other", { name: holder.name || holder.client })
      : t(model.may("operate") ? "control.first" : "control.free");
  fill(
    byId("tools"),
    h(
      "button.key",
      {
        type: "button",
        onclick: askControl,
        className: asking?.length ? "key danger" : "key",
        title: holder ? t("control.title") : t("control.text"),
      },
      h("span", { ariaHidden: "true" }, you ? "\u25cf" : "\u25cb"),
      label,
    ),
    h(
      "button.key",
      { type: "button", onclick: askSettings, ariaLabel: t("settings.title"), title: t("settings.title") },
      "\u2699",
    ),
  );
}

/** Take control, hand it over or give it up. */
async function askControl() {
  const { holder, you, asking, clients } = model.control.value;
  const list = (clients ?? []).map((/** @type {any} */ each) =>
    h(
      "div.row",
      {},
      h("span.grow", {}, `${each.name || each.client} \u00b7 ${each.role}`),
      holder?.client === each.client ? h("strong", {}, t("control.has")) : "",
    ),
  );
  const cancel = { text: t("key.close"), value: null };
  const choices = you
    ? [
        cancel,
        ...(asking ?? []).map((/** @type {any} */ each) => ({
          text: t("control.give", { name: each.name || each.client }),
          value: ["control.give", { client: each.client }],
        })),
        { text: t("control.release"), value: ["control.release", {}] },
      ]
    : [
        cancel,
        ...(holder ? [{ text: t("control.force"), kind: "danger", value: ["control.take", { force: true }] }] : []),
        {
          text: holder ? t("control.ask") : t("control.take"),
          kind: "main",
          value: ["control.take", { force: false }],
        },
      ];
  const chosen = await ask({
    title: t("control.title"),
    body: [h("p", {}, t("control.text")), ...list],
    choices: /** @type {any} */ (choices),
  });
  if (chosen) await give(chosen[0], chosen[1]);
}

/** Appearance and language of this browser. */
async function askSettings() {
  const theme = choiceOf(
    t("settings.theme"),
    { auto: t("theme.auto"), light: t("theme.light"), dark: t("theme.dark") },
    setting("theme", "auto"),
  );
  const language = choiceOf(t("settings.language"), LANGUAGES, setting("language", "en"));
  const { version, role, machine } = model.hello.value;
  const facts = h(
    "p.hint",
    {},
    `${machine.name || machine.kind} \u00b7 ${machine.card} \u00b7 openacr ${version} \u00b7 ${t(/** @type {any} */ (`role.${role}`))}`,
  );
  const other = document.getElementById("status")
    ? h("a", { href: "/bench" }, t("settings.bench"))
    : h("a", { href: "/" }, t("settings.operator"));
  const choices = [
    { text: t("key.cancel"), value: null },
    { text: t("key.ok"), value: true, kind: "main", isSubmit: true },
  ];
  if (
    !(await ask({
      title: t("settings.title"),
      body: [theme, language, other, facts],
      choices: /** @type {any} */ (choices),
    }))
  )
    return;
  const [newTheme, newLanguage] = [theme, language].map((each) => each.querySelector("select")?.value ?? "");
  keepSetting("theme", newTheme);
  applyTheme();
  if (newLanguage === setting("language", "en")) return;
  keepSetting("language", newLanguage);
  window.location.reload();
}

/**
 * @param {string} label
 * @param {Record<string, string>} options
 * @param {string} value
 */
function choiceOf(label, options, value) {
  const list = Object.entries(options).map(([id, text]) => h("option", { value: id, selected: id === value }, text));
  return h("label.row", {}, h("span.grow", {}, label), h("select.field", {}, ...list));
}
