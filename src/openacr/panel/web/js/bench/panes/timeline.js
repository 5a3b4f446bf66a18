// The timeline of a virtual card: time that is still, fast or slow, back, in branches, and two of them compared.
import { get, latest } from "../../core/api.js";
import { give, model, refuse } from "../../core/app.js";
import { fill, h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { plain } from "../../core/format.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { ask } from "../../frame/dialog.js";
import { compare } from "../compared.js";
import { createLanes } from "../lanes.js";
import { secondsOf, within, zoomed } from "../time_view.js";
import { takeWanted } from "../wanted.js";

const TEXTS = {
  pause: { en: "PAUSE", de: "PAUSE" },
  run: { en: "RUN", de: "WEITER" },
  speed: { en: "Speed", de: "Geschwindigkeit" },
  most: { en: "as fast as it goes", de: "so schnell es geht" },
  step: { en: "STEP", de: "SCHRITT" },
  stepWhat: { en: "What a step is", de: "Was ein Schritt ist" },
  stepNumber: { en: "Number of the program or master", de: "Nummer des Programms oder Masters" },
  branch: { en: "NEW BRANCH HERE", de: "NEUER ZWEIG HIER" },
  operate: { en: "OPERATE FROM HERE", de: "VON HIER BEDIENEN" },
  moment: { en: "Moment", de: "Zeitpunkt" },
  memory: {
    en: "{used} MB of {most} MB of memory, nothing on disk",
    de: "{used} MB von {most} MB Speicher, nichts auf der Platte",
  },
  marks: { en: "Bookmarks", de: "Lesezeichen" },
  mark: { en: "MARK", de: "MERKEN" },
  markText: { en: "Text of a bookmark", de: "Text eines Lesezeichens" },
  branches: { en: "Branch", de: "Zweig" },
  from: { en: "from s", de: "von s" },
  to: { en: "to s", de: "bis s" },
  do: { en: "Keys", de: "Tasten" },
  name: { en: "NAME", de: "NAME" },
  switch: { en: "CHANGE TO", de: "WECHSELN" },
  forget: { en: "FORGET", de: "VERGESSEN" },
  at: { en: "Time, s", de: "Zeit, s" },
  atWrong: { en: "{text} is no time: 885.8 or 14:45.8", de: "{text} ist keine Zeit: 885,8 oder 14:45,8" },
  go: { en: "GO", de: "HIN" },
  whole: { en: "ALL", de: "ALLES" },
  unknown: {
    en: "{time} s is not known on this branch: from {first} to {last} s are",
    de: "{time} s ist auf diesem Zweig nicht bekannt: von {first} bis {last} s ist es",
  },
};

const SPEEDS = [0.01, 0.1, 0.5, 1, 2, 5, 10, 100, 0]; // 0: as fast as it goes
const STEPS = ["tick", "back", "line", "move"];
const JUMPS = [-20, -1, 1, 20]; // s
const LOOK_MS = 1000; // from one look at the lanes to the next
const MEGA = 1e6;

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep }) {
  const endings = new Endings();
  const speed = h(
    "select.field",
    { ariaLabel: t(TEXTS.speed), onchange: () => void run() },
    ...SPEEDS.map((each) => h("option", { value: String(each) }, each ? `${each}\u00d7` : t(TEXTS.most))),
  );
  speed.value = "1";
  const run = () => give("timeline.run", { speed: Number(speed.value) || null });
  const pause = keyOf(TEXTS.pause, () => void (model.timeline.value.still ? run() : give("timeline.pause")), ".main");
  const what = h(
    "select.field",
    { ariaLabel: t(TEXTS.stepWhat), onchange: showNumber },
    ...STEPS.map((each) => h("option", { value: each }, t(/** @type {any} */ (`time.step.${each}`)))),
  );
  const number = h("input.field.time-number", {
    type: "number",
    min: "0",
    max: "15",
    value: "0",
    ariaLabel: t(TEXTS.stepNumber),
  });
  const step = () => give("timeline.step", { what: what.value, number: Number(number.value) || 0 });
  const operate = keyOf(TEXTS.operate, () => void give("timeline.operate"));
  const branch = keyOf(TEXTS.branch, () => void give("timeline.branch"));
  head.append(
    pause,
    speed,
    keyOf(TEXTS.step, () => void step()),
    what,
    number,
    branch,
    operate,
  );
  function showNumber() {
    number.hidden = what.value === "tick" || what.value === "back";
  }
  showNumber();

  const slider = h("input.grow.time-slider", {
    type: "range",
    step: "1",
    ariaLabel: t(TEXTS.moment),
    oninput: () => void drag(),
    onchange: () => void drag(),
  });
  const shown = h("strong.live.time-now", {});
  const used = h("span.hint", {});
  const marks = h("div.time-marks.scroll", { role: "group", tabIndex: 0, ariaLabel: t(TEXTS.marks) });
  const rows = h("tbody", {});
  const notHere = h("div.notice", { hidden: true });
  const parts = h("div.grow.scroll", { tabIndex: 0 });
  const text = h("input.field.grow", { ariaLabel: t(TEXTS.markText), placeholder: t(TEXTS.markText), maxLength: 80 });
  const marking = h(
    "form.row",
    {
      onsubmit: (/** @type {Event} */ event) => {
        event.preventDefault();
        void give("timeline.mark", { text: text.value.trim() }).then((done) => {
          if (done) text.value = "";
        });
      },
    },
    text,
    h("button.key", { type: "submit" }, t(TEXTS.mark)),
  );
  const comparing = compare({ kept, keep, seconds });
  const at = h("input.field.time-at", {
    ariaLabel: t(TEXTS.at),
    placeholder: t(TEXTS.at),
    inputMode: "decimal",
    autocomplete: "off",
  });
  const going = h(
    "form.row.wrap",
    {
      onsubmit: (/** @type {Event} */ event) => {
        event.preventDefault();
        const typed = secondsOf(at.value);
        if (typed === null) refuse(t(TEXTS.atWrong, { text: at.value }));
        else void seek(Math.round(typed / model.timeline.value.period_s));
      },
    },
    ...JUMPS.map((each) =>
      h(
        "button.key",
        { type: "button", onclick: () => void jump(each) },
        `${each < 0 ? "\u2212" : "+"}${Math.abs(each)} s`,
      ),
    ),
    at,
    h("button.key", { type: "submit" }, t(TEXTS.go)),
    keyOf(TEXTS.whole, () => look(null)),
    shown,
  );
  /** The part that is shown; null: all of the branch. @type {import("../time_view.js").Part | null} */
  let part = null;
  /** @type {import("../lanes.js").Lane[]} */
  let lanes = [];
  const newest = latest();
  const picture = createLanes({
    seconds,
    seek: (tick) => void seek(tick),
    zoom: (isFiner, tick) => look(zoomed(partNow(), isFiner, tick, whole())),
    pan: (by) => look(within([partNow()[0] + by, partNow()[1] + by], whole())),
  });
  parts.append(
    h("div.row", {}, slider),
    picture.element,
    going,
    used,
    marking,
    marks,
    h(
      "table.grid",
      {},
      h(
        "thead",
        {},
        h("tr", {}, ...[TEXTS.branches, TEXTS.from, TEXTS.to, TEXTS.do].map((each) => h("th", {}, t(each)))),
      ),
      rows,
    ),
    comparing.element,
  );
  host.append(notHere, parts);

  let isAsking = false; // a moment is on its way
  let wanted = Number.NaN;
  async function drag() {
    wanted = Number(slider.value);
    showMoment(wanted);
    if (isAsking) return;
    isAsking = true;
    let isSought = false;
    for (let last = Number.NaN; last !== wanted;) {
      last = wanted;
      isSought = Boolean(await give("timeline.seek", { tick: last }));
    }
    isAsking = false;
    if (!isSought || model.moment.value.tick === wanted) draw(); // else the moment is on its way: the slider stays
  }

  /** First and last tick of the branch. @returns {import("../time_view.js").Part} */
  function whole() {
    const { branch: present, branches } = model.timeline.value;
    return [branches.find((each) => each.number === present)?.first ?? 0, model.moment.value.last];
  }

  function partNow() {
    return part ? within(part, whole()) : whole();
  }

  /** @param {import("../time_view.js").Part | null} chosen */
  function look(chosen) {
    part = chosen && (chosen[1] - chosen[0] < whole()[1] - whole()[0] ? chosen : null);
    draw();
    void readLanes().catch(refuse);
  }

  async function readLanes() {
    const { why, branch: present, branches } = model.timeline.value;
    if (why || !branches.length || !picture.element.offsetParent) return;
    const [first, last] = partNow();
    const found = await newest(get("timeline/lanes", { branch: present, first, last }));
    if (!found) return;
    lanes = found.lanes;
    drawLanes();
  }

  function drawLanes() {
    const { period_s: period, bookmarks } = model.timeline.value;
    picture.draw(partNow(), period, lanes, bookmarks);
    picture.mark(model.moment.value.tick);
  }

  /** @param {number} tick */
  async function seek(tick) {
    const [first, last] = whole();
    if (tick < first || tick > last)
      refuse(t(TEXTS.unknown, { time: seconds(tick), first: seconds(first), last: seconds(last) }));
    else await give("timeline.seek", { tick });
  }

  /** @param {number} by s; it ends at the end of the branch */
  async function jump(by) {
    const [first, last] = whole();
    await seek(
      Math.max(first, Math.min(last, model.moment.value.tick + Math.round(by / model.timeline.value.period_s))),
    );
  }

  /** @param {number} tick */
  function seconds(tick) {
    return plain(tick * model.timeline.value.period_s, 4);
  }

  /** @param {number} tick */
  function showMoment(tick) {
    setText(shown, `${seconds(tick)} s${model.moment.value.within ? ` + ${model.moment.value.within}` : ""}`);
  }

  function draw() {
    const { still, away, branch: present, branches, most_bytes: most } = model.timeline.value;
    const { tick, last, bytes } = model.moment.value;
    const own = branches.find((each) => each.number === present);
    setText(pause, t(still ? TEXTS.run : TEXTS.pause));
    operate.disabled = !away;
    branch.disabled = !away || tick >= last;
    setText(used, t(TEXTS.memory, { used: plain(bytes / MEGA, 1), most: plain(most / MEGA, 0) }));
    if (isAsking || !own) return;
    const [from, to] = partNow();
    [slider.min, slider.max] = [String(from), String(to)];
    slider.value = String(tick);
    drawLanes();
    showMoment(tick);
  }

  function list() {
    const { why, branch: present, branches, bookmarks } = model.timeline.value;
    notHere.hidden = !why;
    parts.hidden = head.inert = Boolean(why);
    setText(notHere, why);
    if (why) return;
    fill(
      marks,
      ...bookmarks.map((each) =>
        h(
          "button.key",
          { type: "button", data: { kind: each.kind }, onclick: () => void give("timeline.seek", { tick: each.tick }) },
          `${seconds(each.tick)} s ${t(/** @type {any} */ (`time.kind.${each.kind}`))}: ${each.text}`,
        ),
      ),
    );
    fill(
      rows,
      ...branches.map((each) =>
        h(
          "tr",
          { data: { branch: String(each.number) }, className: each.number === present ? "is-present" : "" },
          h("td", {}, each.number === present ? h("strong", {}, each.name, " \u25c0") : each.name),
          h("td.number", {}, seconds(each.fork ?? each.first)),
          h("td.number", {}, each.last === null ? "\u2026" : seconds(each.last)),
          h(
            "td.row.wrap",
            {},
            keyOf(TEXTS.name, () => void rename(each)),
            ...(each.number === present
              ? []
              : [
                  keyOf(TEXTS.switch, () => void give("timeline.switch", { number: each.number })),
                  keyOf(TEXTS.forget, () => void give("timeline.forget", { number: each.number })),
                ]),
          ),
        ),
      ),
    );
    comparing.offer(branches.filter((each) => each.number !== present));
    draw();
  }

  /** @param {import("../../core/model.js").TimeBranch} branchOf */
  async function rename(branchOf) {
    const field = h("input.field", { value: branchOf.name, maxLength: 80, ariaLabel: t(TEXTS.name) });
    const name = await ask({
      title: t(TEXTS.name),
      body: [field],
      first: field,
      choices: [
        { text: t(TEXTS.name), kind: "main", isSubmit: true, value: () => field.value.trim() || undefined },
        { text: t("key.cancel"), value: null },
      ],
    });
    if (name) await give("timeline.name", { number: branchOf.number, name });
  }

  const timer = setInterval(() => void readLanes().catch(() => {}), LOOK_MS); // a link that is lost says so elsewhere
  endings.add(
    model.timeline.watch(list),
    model.timeline.watch(() => void readLanes().catch(() => {})),
    model.moment.watch(draw),
    takeWanted("timeline", comparing.add),
    () => comparing.end(),
    () => clearInterval(timer),
  );
  return () => endings.end();
}
