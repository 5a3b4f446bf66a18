// SCOPE: four channels sampled by the card on ten by ten divisions, with a trigger and an index move.
import { give, link, model, refuse } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { keepSetting, setting } from "../core/settings.js";
import { Endings } from "../core/signal.js";
import { t } from "../core/texts.js";
import { confirm } from "../frame/dialog.js";
import { mayMove } from "../motion/actions.js";
import { arm as armed, resumed } from "../scope/arm.js";
import { Recording } from "../scope/recording.js";
import { DIVISIONS, fitting } from "../scope/scales.js";
import { COLORS, createScreen } from "../scope/screen.js";
import { stateOf, stateText } from "../scope/state.js";

const TEXTS = {
  indexText: {
    en: "The axis moves now: {move}. Is its path free?",
    de: "Die Achse fährt jetzt: {move}. Ist ihr Weg frei?",
  },
  profile: { en: "Index profile", de: "Index-Profil" },
  range: { en: "Sweep and sampling are times above 0 ms", de: "Ablenkung und Abtastung sind Zeiten über 0 ms" },
};

const CHANNELS = 4;
const PROFILE = "ACC 500\nDEC 500\nSTP 500\nJRK 0\nF500\nRES X\nX15";
const SOURCES = ["P12291", "P12290", "P12295", ""];

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "scope.title",
  area: "full",
  mode: "manual",
  show({ body, head, endings }) {
    const channels = Array.from({ length: CHANNELS }, (_each, n) => ({
      source: textField(t("scope.channel", { n: n + 1 }), `scope.source${n}`, SOURCES[n]),
      scale: numberField(t("scope.scale", { n: n + 1 }), `scope.scale${n}`, "50"),
      offset: numberField(t("scope.offset", { n: n + 1 }), `scope.offset${n}`, "0"),
    }));
    const sweep = numberField(t("scope.sweep"), "scope.sweep", "200");
    const period = numberField(t("scope.period"), "scope.period", "5");
    const level = numberField(t("scope.level"), "scope.level", "0");
    const mode = selectField(t("scope.mode"), ["free", "auto", "normal", "single"]);
    const slope = selectField(t("scope.slope"), ["rising", "falling"]);
    const profile = h("textarea.field.mono", {
      ariaLabel: t(TEXTS.profile),
      value: setting("scope.profile", PROFILE),
      spellcheck: false,
      rows: 7,
    });
    const state = h("span.hint.grow", { role: "status" });
    const chart = h("div.scope-chart.grow", {});
    const recording = new Recording();
    const run = new Endings();
    endings.add(
      () => run.end(),
      () => void (link.isOpen.value && link.command("scope.stop").catch(() => {})),
    );
    head.append(
      keyOf("scope.start", () => arm(null), ".main"),
      keyOf("scope.index", index, ".danger"),
      keyOf("scope.stop", stop),
      keyOf("scope.autoscale", autoscale),
    );
    body.append(
      h(
        "div.scope-side.scroll",
        {},
        h(
          "div.scope-channel",
          {},
          h("span", {}),
          ...["scope.head.source", "scope.head.scale", "scope.head.offset"].map((each) =>
            h("span.hint", {}, t(/** @type {any} */ (each))),
          ),
        ),
        ...channels.map((each, n) =>
          h(
            "div.scope-channel",
            { data: { channel: String(n + 1) } },
            h("strong", {}, String(n + 1)),
            each.source,
            each.scale,
            each.offset,
          ),
        ),
        h(
          "div.scope-settings",
          {},
          row(t("scope.sweep"), sweep),
          row(t("scope.period"), period),
          row(t("scope.mode"), mode),
          row(t("scope.slope"), slope),
          row(t("scope.level"), level),
        ),
        h("label.stack", {}, t(TEXTS.profile), profile),
      ),
      h("div.stack.grow", {}, chart, state),
    );
    body.classList.add("is-scope");
    const screenOf = createScreen(chart, endings);
    const draw = () => {
      const { channels: records, period: every, first, zero } = recording.window();
      const start = (first - zero) * every * 1000;
      screenOf.draw(
        records.map((values, n) => ({
          label: String(n + 1),
          color: COLORS[n],
          values,
          scale: numberOf(channels[n].scale) || 1,
          offset: numberOf(channels[n].offset),
        })),
        { start, period: every, from: start, step: numberOf(sweep) },
      );
    };
    const tell = () =>
      setText(
        state,
        stateText(
          stateOf(model.capture.value, run.list.length ? recording : null),
          model.capture.value,
          recording.count,
        ),
      );
    for (const { scale, offset } of channels)
      for (const field of [scale, offset]) field.addEventListener("input", draw);
    endings.add(
      resumed(() => (run.list.length ? recording.number : 0)),
      model.scope.watch((piece) => {
        if (!piece || !run.list.length) return;
        recording.add(piece);
        tell();
        draw();
      }),
      model.capture.watch((capture) => {
        if (!run.list.length) return;
        recording.note(capture);
        tell();
        draw();
      }),
    );
    draw();

    /** Values of the fields, or null where one is wrong. */
    function settings() {
      for (const field of body.querySelectorAll("input[data-setting]"))
        keepSetting(/** @type {any} */ (field).dataset.setting, /** @type {any} */ (field).value);
      const [sweepMs, periodMs] = [numberOf(sweep), numberOf(period)];
      if (!(sweepMs > 0) || !(periodMs > 0)) {
        refuse(t(TEXTS.range));
        return null;
      }
      return {
        channels: channels.map(({ source }) => source.value.trim()).filter(Boolean),
        period_ms: periodMs,
        sweep_ms: DIVISIONS * sweepMs,
      };
    }

    /** @param {string | null} text a profile that is run and recorded, or null */
    async function arm(text) {
      const chosen = settings();
      if (!chosen) return;
      run.end();
      const free = text !== null || mode.value === "free";
      const trigger = free
        ? null
        : {
            channel: 0,
            level: numberOf(level),
            slope: slope.value === "rising" ? 1 : -1,
            mode: mode.value,
            before: 0.1,
          };
      run.add(link.subscribe({ topic: "scope", hz: 10 }));
      const begun =
        text === null
          ? await armed("scope.arm", { ...chosen, trigger })
          : await armed("scope.index", { ...chosen, profile: text });
      if (begun) recording.begin(begun.channels.length, begun, trigger, text === null ? "sweep" : "once");
      tell();
      draw();
    }

    async function index() {
      keepSetting("scope.profile", profile.value);
      if (
        !mayMove() ||
        !(await confirm(
          t("scope.index"),
          t(TEXTS.indexText, { move: profile.value.trim().split("\n").at(-1) ?? "" }),
          t("scope.index"),
        ))
      )
        return;
      await arm(profile.value);
    }

    async function stop() {
      run.end(); // samples under way change nothing any more
      await give("scope.stop");
      setText(state, t("scope.stopped", { count: recording.count }));
    }

    /** Scales of 1, 2 or 5 that show each channel whole, with its middle in the middle. */
    function autoscale() {
      recording.window().channels.forEach((values, n) => {
        const fit = fitting(values);
        if (!fit) return;
        channels[n].scale.value = String(fit.scale);
        channels[n].offset.value = String(fit.offset);
      });
      draw();
    }
  },
};

/** @param {HTMLInputElement} field */
function numberOf(field) {
  return Number(field.value.replace(",", "."));
}

/**
 * @param {string} label
 * @param {HTMLElement} field
 */
function row(label, field) {
  return h("label.row", {}, h("span.grow", {}, label), field);
}

/**
 * @param {string} label
 * @param {string} name
 * @param {string} value
 */
function textField(label, name, value) {
  return h("input.field", {
    ariaLabel: label,
    title: label,
    placeholder: t("scope.source"),
    value: setting(name, value),
    autocomplete: "off",
    spellcheck: false,
    data: { setting: name },
  });
}

/**
 * @param {string} label
 * @param {string} name
 * @param {string} value
 */
function numberField(label, name, value) {
  const field = textField(label, name, value);
  field.classList.add("number");
  field.inputMode = "decimal";
  field.placeholder = "";
  return field;
}

/**
 * @param {string} label
 * @param {string[]} values
 */
function selectField(label, values) {
  return h(
    "select.field",
    { ariaLabel: label },
    ...values.map((value) => h("option", { value }, t(/** @type {any} */ (`scope.${value}`)))),
  );
}
