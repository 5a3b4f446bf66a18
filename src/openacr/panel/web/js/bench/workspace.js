// The panes side by side, or on a narrow screen one at a time; the layout is kept by this browser.
import { createDockview } from "../../vendor/dockview.js";
import { refuse } from "../core/app.js";
import { byId, h } from "../core/dom.js";
import { Signal } from "../core/signal.js";
import { t } from "../core/texts.js";
import { showPane } from "./content.js";
import { JOBS, firstLayout, keepJob, keepLayout, panesOf, presentJob, presentLayout } from "./layouts.js";
import { NARROW } from "./narrow.js";
import { PANES } from "./panes.js";

/** @typedef {import("../../vendor/dockview.js").DockviewApi} DockviewApi */

/** @type {DockviewApi} */
let dock;
/** @type {Map<string, () => boolean | Promise<boolean>>} */
const closing = new Map();
let isLoading = false;
let form = formOf();
/** What the workspace is used for now: each job has a layout of its own. */
export const job = new Signal(presentJob());

export function startWorkspace() {
  dock = createDockview(byId("work"), {
    theme: { name: "openacr", className: "dockview-theme-light" },
    disableFloatingGroups: true,
    disableDnd: NARROW.matches,
    scrollbars: "native",
    createComponent: ({ id, name }) => contentOf(id, name),
    createTabComponent: () => tabOf(),
    defaultTabComponent: "tab",
    createWatermarkComponent: () => ({ element: h("p.bench-empty", {}, t("bench.empty")), init: () => {} }),
  });
  load();
  dock.onDidLayoutChange(() => {
    if (!isLoading) keepLayout(form, job.value, dock.toJSON());
  });
  NARROW.addEventListener("change", () => {
    form = formOf();
    dock.updateOptions({ disableDnd: NARROW.matches });
    const shown = dock.activePanel?.id ?? "";
    load();
    dock.getPanel(shown)?.api.setActive(); // a tablet that is turned keeps the pane in use
  });
}

/** @returns {"wide" | "narrow"} */
function formOf() {
  return NARROW.matches ? "narrow" : "wide";
}

/**
 * Open a pane, or show the one that is open; of some panes there may be several.
 * @param {string} pane
 * @param {{ isNew?: boolean }} [options]
 */
export function openPane(pane, { isNew = false } = {}) {
  const open = dock.panels.filter((each) => each.view.contentComponent === pane);
  if (open.length && !(isNew && open.length < (PANES[pane].most ?? 1))) open[0].api.setActive();
  else {
    const beside = (PANES[pane].isLarge && largestPanel()) || dock.activePanel;
    addPane(
      pane,
      open.map((each) => each.id),
      beside ? { referencePanel: beside.id, direction: "within" } : undefined,
    );
  }
}

/** What is shown in the largest place. */
function largestPanel() {
  const area = (/** @type {{ width: number, height: number }} */ group) => group.width * group.height;
  return [...dock.groups].sort((one, other) => area(other) - area(one))[0]?.activePanel;
}

/**
 * @param {string} pane
 * @param {string[]} taken ids that others have
 * @param {any} [position]
 */
function addPane(pane, taken, position) {
  let n = 1;
  while (taken.includes(`${pane}-${n}`)) n++;
  dock.addPanel({ id: `${pane}-${n}`, component: pane, title: titleOf(pane, n), position });
}

/**
 * @param {string} pane
 * @param {number} n
 */
function titleOf(pane, n) {
  return n > 1 ? `${t(PANES[pane].title)} ${n}` : t(PANES[pane].title);
}

/** @param {string} id of a panel: its pane and which of them it is */
function numberOf(id) {
  return Number(id.split("-")[1]);
}

/** Lay the panes out as they were kept, else as at first. @param {{ isReusing?: boolean }} [options] */
function load(options) {
  arrange(presentLayout(form, job.value), options);
}

/**
 * Change to the layout of another job, which is as it was left. Panes that are in both stay as they are; one that is
 * not, with changes, may keep the present layout.
 * @param {import("./layouts.js").Job} wanted
 */
export async function chooseJob(wanted) {
  if (wanted === job.value) return;
  const next = presentLayout(form, wanted);
  const stays = next?.panels ?? Object.fromEntries(panesOf(wanted).map((pane) => [`${pane}-1`, true]));
  for (const [id, mayClose] of closing) if (!(id in stays) && !(await mayClose())) return;
  keepLayout(form, job.value, dock.toJSON());
  keepJob(wanted);
  job.set(wanted);
  load({ isReusing: true });
}

/**
 * Lay panes out; without a layout, or with one that cannot be used, as at first. A narrow screen has all panes in one
 * place.
 * @param {import("./layouts.js").Layout | null} layout
 * @param {{ isReusing?: boolean }} [options] whether panes that are open stay as they are
 */
export function arrange(layout, { isReusing = false } = {}) {
  const options = { reuseExistingPanels: isReusing };
  isLoading = true;
  try {
    if (layout && form === "narrow")
      inOnePlace(Object.values(layout.panels).map((each) => [each.id, each.params ?? {}]));
    else if (layout) dock.fromJSON(known(layout), options);
    else first(options);
  } catch {
    dock.clear();
    first();
  }
  isLoading = false;
  for (const panel of dock.panels) panel.api.setTitle(titleOf(panel.view.contentComponent, numberOf(panel.id)));
  keepLayout(form, job.value, layout ? dock.toJSON() : null);
}

/** The first layout of the job. @param {{ reuseExistingPanels: boolean }} [options] */
function first(options) {
  const { width, height } = byId("work").getBoundingClientRect();
  if (form === "narrow") inOnePlace(panesOf(job.value).map((pane) => [`${pane}-1`, {}]));
  else dock.fromJSON(firstLayout(job.value, { width, height }), options);
  dock.getPanel(`${JOBS[job.value].largest}-1`)?.api.setActive();
}

/** @param {[string, Record<string, any>][]} panes ids of panels, and what is kept of them */
function inOnePlace(panes) {
  dock.clear();
  for (const [id, kept] of panes) {
    const [pane] = id.split("-");
    if (pane in PANES)
      dock.addPanel({
        id,
        component: pane,
        title: titleOf(pane, numberOf(id)),
        params: kept,
        inactive: dock.totalPanels > 0,
      });
  }
}

/**
 * A layout whose panes all exist; Error for another one.
 * @param {import("./layouts.js").Layout} layout
 */
function known(layout) {
  const strange = Object.values(layout.panels).find((each) => !((each.contentComponent ?? "") in PANES));
  if (strange) throw new Error(`${strange.id} is no pane`);
  return layout;
}

/**
 * Show an open pane by its place in the order of the layout; nothing where there is none.
 * @param {number} place from 0
 */
export function showPaneAt(place) {
  dock.groups.flatMap((group) => group.panels)[place]?.api.setActive();
}

/** Close the active pane. */
export async function closePane() {
  const panel = dock.activePanel;
  if (panel && (await closing.get(panel.id)?.()) !== false) panel.api.close();
}

/** The present layout, to be kept under a name. */
export function layoutNow() {
  return dock.toJSON();
}

/** Whether all panes may be closed: those with changes ask. */
export async function mayCloseAll() {
  for (const mayClose of closing.values()) if (!(await mayClose())) return false;
  return true;
}

/**
 * @param {string} id
 * @param {string} name
 * @returns {import("../../vendor/dockview.js").IContentRenderer}
 */
function contentOf(id, name) {
  const element = h("section.bench-pane", { data: { pane: name } });
  let begin = () => {};
  let end = () => {};
  return {
    element,
    init({ api, params, title }) {
      element.ariaLabel = title;
      begin = () => {
        const shown = showPane(element, PANES[name], {
          number: numberOf(id),
          kept: params,
          keep: (values) => api.updateParameters({ ...api.getParameters(), ...values }),
        });
        closing.set(id, shown.mayClose);
        end = shown.end;
        begin = () => {}; // it goes on while another tab covers it
      };
    },
    onShow() {
      begin();
    },
    dispose() {
      closing.delete(id);
      end();
    },
  };
}

/** @returns {import("../../vendor/dockview.js").ITabRenderer} */
function tabOf() {
  const text = h("span.bench-tab-text", {});
  const element = h("div.bench-tab", {}, text);
  return {
    element,
    init({ api, title }) {
      const close = async () => (await closing.get(api.id)?.()) !== false && api.close();
      const key = h(
        "span.bench-close",
        {
          ariaHidden: "true",
          onclick: (/** @type {Event} */ event) => {
            event.preventDefault();
            close().catch(refuse);
          },
          onpointerdown: (/** @type {Event} */ event) => event.stopPropagation(),
        },
        "\u00d7",
      );
      text.textContent = title;
      [element.dataset.tab] = api.id.split("-");
      api.onDidTitleChange((changed) => {
        text.textContent = changed.title;
      });
      element.append(key);
      element.addEventListener("auxclick", (event) => event.button === 1 && close().catch(refuse));
    },
  };
}
