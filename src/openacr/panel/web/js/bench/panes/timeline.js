// The timeline of a virtual card: time that is still, fast or slow, back, in branches, and two of them compared.
import { get, latest } from "../../core/api.js";
import { give, model, refuse } from "../../core/app.js";
import { h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { plain } from "../../core/format.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { createBranches } from "../branches.js";
import { compare } from "../compared.js";
import { createFirstDifference } from "../first_difference.js";
import { lanesOf } from "../lane_list.js";
import { createLanes } from "../lanes.js";
import { keepInOneRow } from "../overflow.js";
import { createSelection } from "../selection.js";
import { createTimeKeys } from "../time_keys.js";
import { createMarks } from "../time_marks.js";
import { createSearch } from "../time_search.js";
import { keyed, secondsOf, within, zoomed } from "../time_view.js";
import { takeWanted } from "../wanted.js";

const TEXTS = {
  moment: { en: "Moment", de: "Zeitpunkt" },
  memory: {
    en: "{used} MB of {most} MB of memory, nothing on disk",
    de: "{used} MB von {most} MB Speicher, nichts auf der Platte",
  },
  at: { en: "Time, s", de: "Zeit, s" },
  atWrong: { en: "{text} is no time: 885.8 or 14:45.8", de: "{text} ist keine Zeit: 885,8 oder 14:45,8" },
  go: { en: "GO", de: "HIN" },
  whole: { en: "ALL", de: "ALLES" },
  unknown: {
    en: "{time} s is not known on this branch: from {first} to {last} s are",
    de: "{time} s ist auf diesem Zweig nicht bekannt: von {first} bis {last} s ist es",
  },
};

const JUMPS = [-20, -1, 1, 20]; // s
const LOOK_MS = 1000; // from one look at the lanes to the next
const DETAILED = 20; // s that are shown in detail at most
const AROUND = 1; // s shown before and after a difference
const MEGA = 1e6;

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep }) {
  const endings = new Endings();
  const keys = createTimeKeys(head);
  endings.add(keepInOneRow(head));
  const slider = h("input.grow.time-slider", {
    type: "range",
    step: "1",
    ariaLabel: t(TEXTS.moment),
    oninput: () => void drag(),
    onchange: () => void drag(),
  });
  const shown = h("strong.live.time-now", {});
  const used = h("span.hint", {});
  const notHere = h("div.notice", { hidden: true });
  const parts = h("div.grow.scroll", { tabIndex: 0 });
  const marks = createMarks({ seconds });
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
  /** The branch whose lanes are drawn below those of the present one. @type {number | null} */
  let compared = null;
  let read = ""; // which details are shown
  /** @type {import("../lane_paint.js").Details | null} */
  let details = null;
  const [newest, newestDetails] = [latest(), latest()];
  const picture = createLanes({
    seconds,
    seek: (tick) => void seek(tick),
    zoom: (isFiner, tick) => look(zoomed(partNow(), isFiner, tick, whole())),
    pan: (by) => look(within([partNow()[0] + by, partNow()[1] + by], whole())),
    select: (chosen) => void select(chosen),
    kept: { ...kept.lanes },
    keep: (lanes) => keep({ lanes }),
  });
  const branches = createBranches({
    seconds,
    compare: (number) => {
      compared = compared === number ? null : number;
      drawLanes();
      void readLanes().catch(refuse);
    },
    first: (number) => void firstDifference.find(number),
  });
  const firstDifference = createFirstDifference({
    seconds,
    seek,
    show: (other, tick) => {
      compared = other;
      const reach = Math.round(AROUND / model.timeline.value.period_s);
      look(within([tick - reach, tick + reach], whole()));
    },
  });
  const selection = createSelection({
    seconds,
    period: () => model.timeline.value.period_s,
    branch: () => model.timeline.value.branch,
    most: DETAILED,
    zoom: (chosen) => look(within(chosen, whole())),
    curves: (chosen, names) => void comparing.over(chosen, names),
    clear: () => void select(null),
  });
  const search = createSearch({
    now: () => ({ ...model.timeline.value, tick: model.moment.value.tick }),
    seek,
    kept: { ...kept.search },
    keep: (values) => keep({ search: values }),
  });
  parts.append(
    h("div.row", {}, slider),
    branches.lanes,
    firstDifference.element,
    picture.element,
    going,
    search.element,
    selection.element,
    used,
    marks.element,
    branches.table,
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
    const { branch: present, branches: all } = model.timeline.value;
    return [all.find((each) => each.number === present)?.first ?? 0, model.moment.value.last];
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
    const { why, branch: present, branches: all } = model.timeline.value;
    if (why || !all.length || !picture.element.offsetParent) return;
    const [first, last] = partNow();
    if (!all.some((each) => each.number === compared) || compared === present) compared = null;
    const other = compared;
    const found = await newest(
      Promise.all([
        get("timeline/lanes", { branch: present, first, last }),
        other === null ? null : get("timeline/lanes", { branch: other, first, last }),
      ]),
    );
    if (!found) return;
    const [own, others] = found;
    void readDetails(present, first, last).catch(() => {}); // a refusal is that of a moment: lanes are drawn
    picture.show({ lanes: lanesOf(own), other: others && lanesOf(others), details });
    drawLanes();
  }

  /** @param {number} branch @param {number} first @param {number} last */
  async function readDetails(branch, first, last) {
    const asked = `${branch} ${first} ${last}`;
    if (asked === read) return;
    read = asked;
    details = null;
    if (part === null || (last - first) * model.timeline.value.period_s > DETAILED) return;
    const found = await newestDetails(
      get("timeline/details", { branch, first, last, columns: Math.max(2, picture.element.clientWidth >> 1) }),
    );
    if (!found || read !== asked) return;
    details = { ...found, part: [found.first, found.last] };
    picture.detail(/** @type {import("../lane_paint.js").Details} */ (details));
  }

  function drawLanes() {
    const { period_s: period, bookmarks, branch: present, branches: all } = model.timeline.value;
    picture.draw(partNow(), period, bookmarks);
    picture.mark(model.moment.value.tick);
    branches.draw(all, present, compared, model.moment.value.last, partNow());
  }

  /** @param {import("../time_view.js").Part | null} chosen */
  async function select(chosen) {
    picture.choose(chosen);
    await selection.show(chosen).catch(refuse);
  }

  host.addEventListener("keydown", (event) => {
    const field = event.target instanceof Element && event.target.closest("input, select, textarea");
    if (field || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === "Escape") return void select(null);
    if (event.key.toLowerCase() === "f") return firstDifference.byKey(compared);
    const held = Number.isNaN(picture.pointed()) ? model.moment.value.tick : picture.pointed();
    const next = keyed(event.key, partNow(), held, whole());
    if (!next) return;
    event.preventDefault();
    look(next);
  });

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
    const { still, away, branch: present, branches: all, most_bytes: most } = model.timeline.value;
    const { tick, last, bytes } = model.moment.value;
    const own = all.find((each) => each.number === present);
    keys.show({ still, away, isEnd: tick >= last });
    setText(used, t(TEXTS.memory, { used: plain(bytes / MEGA, 1), most: plain(most / MEGA, 0) }));
    if (isAsking || !own) return;
    const [from, to] = partNow();
    [slider.min, slider.max] = [String(from), String(to)];
    slider.value = String(tick);
    drawLanes();
    showMoment(tick);
  }

  function list() {
    const { why, branch: present, branches: all, bookmarks } = model.timeline.value;
    notHere.hidden = !why;
    parts.hidden = head.inert = Boolean(why);
    setText(notHere, why);
    if (why) return;
    marks.list(bookmarks);
    branches.list(all, present);
    const others = all.filter((each) => each.number !== present);
    comparing.offer(others);
    firstDifference.keep(others.map((each) => each.number));
    draw();
  }

  const timer = setInterval(() => void readLanes().catch(() => {}), LOOK_MS); // a link that is lost says so elsewhere
  endings.add(
    model.timeline.watch(list),
    model.timeline.watch(() => void readLanes().catch(() => {})),
    model.moment.watch(draw),
    takeWanted("timeline", comparing.add),
    () => comparing.end(),
    () => picture.end(),
    () => clearInterval(timer),
  );
  return () => endings.end();
}
