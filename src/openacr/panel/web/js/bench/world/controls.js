// What is changed by hand in the world: inputs, devices, faults.
import { give, model } from "../../core/app.js";
import { fill, h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { textOr, t } from "../../core/texts.js";
import { logIn } from "../../frame/log_in.js";

/**
 * @typedef {import("../panes/world.js").About} About
 * @typedef {import("../../core/frames.js").World} World
 */

/**
 * Change the world; a role that is too low is asked for its password.
 * @param {string} command
 * @param {Record<string, any>} args
 */
async function change(command, args) {
  if (model.may("service") || (await logIn("service"))) await give(command, args);
}

/**
 * The inputs with what drives them and their keys.
 * @param {About["inputs"]} inputs
 */
export function inputTable(inputs) {
  const rows = inputs.map(({ input, what, is_driven: isDriven }) => {
    const [lamp, state] = [h("span.lamp", { ariaHidden: "true" }), h("span.io-state", {})];
    const key = (/** @type {"on" | "off" | "released"} */ wish) =>
      keyOf(`world.input.${wish}`, () => void change("world.input", { input, state: wish }), "", {
        ariaLabel: t(`world.input.${wish}.of`, { input }),
      });
    const keys = { on: key("on"), off: key("off"), released: key("released") };
    const element = h(
      "div.world-input",
      { data: { input: String(input) } },
      lamp,
      h("span.number", {}, String(input)),
      h("span.world-source", { title: what }, what || t("world.by.hand")),
      state,
      h("span.row", {}, keys.on, keys.off, isDriven ? keys.released : ""),
    );
    return { input, isDriven, lamp, state, keys, element };
  });
  const [driven, others] = [rows.filter(({ isDriven }) => isDriven), rows.filter(({ isDriven }) => !isDriven)];
  return {
    elements: [
      ...driven.map(({ element }) => element),
      ...(others.length
        ? [
            h(
              "details.world-others",
              { open: !driven.length },
              h("summary.key", {}, t("world.others", { count: others.length })),
              ...others.map(({ element }) => element),
            ),
          ]
        : []),
    ],
    /** @param {World} world */
    show({ on, forced }) {
      for (const { input, lamp, state, keys, element } of rows) {
        const [isOn, isForced] = [on.includes(input), forced.includes(input)];
        lamp.classList.toggle("is-on", isOn);
        element.classList.toggle("is-forced", isForced);
        setText(state, t(isForced ? (isOn ? "io.forced.on" : "io.forced.off") : isOn ? "io.on" : "io.off"));
        keys.on.setAttribute("aria-pressed", String(isForced && isOn));
        keys.off.setAttribute("aria-pressed", String(isForced && !isOn));
        keys.released.disabled = !isForced;
      }
    },
  };
}

/**
 * The faults there are, and a form that causes another one.
 * @param {About} about
 */
export function faultForm({ links, faults }) {
  const [axis, kind, value, range, list] = [
    h("select.field", { ariaLabel: t("world.fault.axis") }),
    h("select.field", { ariaLabel: t("world.fault.kind") }),
    h("input.field.number", { type: "text", inputMode: "decimal", autocomplete: "off" }),
    h("span.hint", {}),
    h("div.stack", {}),
  ];
  const cause = h("button.key.danger", { type: "submit" }, t("world.fault.cause"));
  const nameOf = (/** @type {number} */ number) => links.find((link) => link.axis === number)?.name ?? String(number);
  const wordOf = (/** @type {string} */ word) => textOr(`world.fault.${word}`, word);
  const chosen = () => faults.find((each) => each.axis === Number(axis.value) && each.kind === kind.value);
  fill(axis, ...links.map((link) => h("option", { value: String(link.axis) }, link.name)));

  function showKinds() {
    const before = kind.value;
    fill(
      kind,
      ...faults
        .filter((each) => each.axis === Number(axis.value))
        .map((each) =>
          h("option", { value: each.kind, disabled: Boolean(each.why_not), title: each.why_not }, wordOf(each.kind)),
        ),
    );
    if (faults.some((each) => each.kind === before && each.axis === Number(axis.value) && !each.why_not))
      kind.value = before;
    showQuantity();
  }

  function showQuantity() {
    const found = chosen();
    value.hidden = !found?.key;
    value.ariaLabel = found?.key ? textOr(`world.fault.${found.key}`, found.key) : "";
    setText(
      range,
      found?.key ? [value.ariaLabel, found.unit, found.range && `(${found.range})`].filter(Boolean).join(" ") : "",
    );
  }

  axis.addEventListener("change", showKinds);
  kind.addEventListener("change", showQuantity);
  showKinds();
  const form = h(
    "form.row.wrap",
    {
      onsubmit: (/** @type {Event} */ event) => {
        event.preventDefault();
        const found = chosen();
        if (!found) return;
        const number = Number(value.value.replace(",", "."));
        void change("world.fault", { axis: found.axis, kind: found.kind, ...(found.key ? { value: number } : {}) });
      },
    },
    axis,
    kind,
    value,
    range,
    cause,
  );
  let shown = "";
  return {
    elements: [form, list],
    /** @param {World} world */
    show(world) {
      const text = JSON.stringify(world.faults);
      if (text === shown) return;
      shown = text;
      fill(
        list,
        ...world.faults.map((fault) => {
          const about = faults.find((each) => each.axis === fault.axis && each.kind === fault.kind);
          const name = `${nameOf(fault.axis)}: ${wordOf(fault.kind)}${about?.key ? ` ${fault.value} ${about.unit}` : ""}`;
          return h(
            "div.notice.bad.row",
            { data: { fault: `${fault.axis}.${fault.kind}` } },
            h("span.grow", {}, name),
            keyOf("world.mend", () => void change("world.mend", { axis: fault.axis, kind: fault.kind }), "", {
              ariaLabel: t("world.mend.of", { name }),
            }),
          );
        }),
      );
    },
  };
}

/**
 * The devices with their signals, and the commands that are given by hand.
 * @param {About["devices"]} devices
 */
export function deviceList(devices) {
  const rows = devices.map(({ name, kind, by_hand: byHand }) => {
    const signals = h("span.hint", {});
    /** @type {Record<string, HTMLButtonElement>} */
    const contacts = {};
    const commands = Object.entries(byHand).map(([command, type]) => {
      if (type !== "bool") return numberCommand(name, command);
      contacts[command] = h(
        "button.key",
        {
          type: "button",
          ariaLabel: `${name}: ${command}`,
          onclick: () => {
            const isOn = contacts[command].getAttribute("aria-pressed") === "true";
            void change("world.command", { device: name, name: command, value: isOn ? 0 : 1 });
          },
        },
        command,
      );
      return contacts[command];
    });
    return {
      contacts,
      signals,
      element: h(
        "div.world-device",
        { data: { device: name } },
        h("strong", {}, name),
        name === kind ? "" : h("span.quiet", {}, ` ${kind}`),
        signals,
        h("div.row.wrap", {}, ...commands),
      ),
    };
  });
  return {
    elements: rows.map(({ element }) => element),
    /** @param {World} world */
    show(world) {
      rows.forEach(({ contacts, signals }, n) => {
        const state = world.devices[n];
        setText(
          signals,
          [state.commands, state.signals]
            .map((values) =>
              Object.entries(values)
                .map(([name, value]) => `${name} ${textOf(value)}`)
                .join(", "),
            )
            .join(" \u2192 "),
        );
        for (const [name, key] of Object.entries(contacts))
          key.setAttribute("aria-pressed", String(state.commands[name] === true));
      });
    },
  };
}

/**
 * @param {string} device
 * @param {string} name
 */
function numberCommand(device, name) {
  const field = h("input.field.number", {
    type: "text",
    inputMode: "decimal",
    ariaLabel: `${device}: ${name}`,
    placeholder: name,
    autocomplete: "off",
  });
  return h(
    "form.row",
    {
      onsubmit: (/** @type {Event} */ event) => {
        event.preventDefault();
        void change("world.command", { device, name, value: Number(field.value.replace(",", ".")) });
      },
    },
    field,
    h("button.key", { type: "submit" }, t("values.set")),
  );
}

/** @param {boolean | number} value */
function textOf(value) {
  return typeof value === "boolean" ? t(value ? "io.on" : "io.off") : String(Number(value.toPrecision(4)));
}
