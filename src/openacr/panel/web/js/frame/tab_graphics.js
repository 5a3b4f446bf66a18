// The GRAPHICS tab: the path of the loaded program, what is cut of it, and the tool. Default Graphics says
// whether a program is drawn when it is loaded, or at the key DRAW.
import { get } from "../core/api.js";
import { model } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { duration } from "../core/format.js";
import { t } from "../core/texts.js";
import { chosenLine, fetchPath, path, reached } from "../draw/path.js";
import { createPicture } from "../draw/picture.js";
import { stockView } from "./stock_view.js";

const FLIPS = Object.freeze({ x: "850021", y: "850022", exchange: "850023" });
let [loadOf, pathOf] = ["", ""]; // the load that is followed, and the program whose path is kept
let [cut, lastLine, lastTime] = [0, 0, 0];

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export async function graphicsTab(panel, endings) {
  panel.classList.add("graphics");
  const note = h("div.picture-note", { attr: { "aria-live": "polite" } });
  const stock = stockView();
  const drawKey = keyOf(
    "graphics.draw",
    () => {
      drawKey.hidden = true;
      void begin(model.program.value.loaded?.id ?? "");
    },
    "",
    { hidden: true },
  );
  const picture = await createPicture(panel, endings, {
    clicked: (line) => chosenLine.set(line),
    hasTool: true,
    more: [drawKey, stock.key],
  });
  stock.show(picture, endings);
  let isOld = false;
  const turn = async () => {
    const flip = await readFlips();
    if (flip) picture.setFlip(flip);
  };
  const renew = () => {
    if (!isOld || model.state.value.running) return; // what is cut stays as it was drawn
    isOld = false;
    void read(pathOf);
    void turn();
    stock.renew();
  };
  panel.append(note, stock.note);
  endings.add(
    path.watch((drawn) => {
      picture.setPath(drawn);
      picture.cutTo(cut);
    }),
    chosenLine.watch((line) => picture.choose(line)),
    model.program.watch((program) => {
      follow(program.loaded);
      stock.follow(program.loaded?.id ?? "");
      drawKey.hidden = Boolean(pathOf) || !program.loaded;
      setText(note, program.loading ? t("graphics.loading", { name: program.loading.name }) : noteOf(program.loaded));
    }),
    model.status.watch((status) => status && draw(status)),
    model.hello.watch(() => picture.setLimits(limitsOf())),
    model.changed.watch(({ what }) => {
      if (what === "forms") isOld = true; // offsets shift the path, DISPLAY flips it
      renew();
    }),
    model.state.watch(renew),
  );
  void turn();

  /** @param {import("../core/frames.js").Status} status */
  function draw(status) {
    const places = [0, 1, 2].map((n) => status.machine[n] ?? 0);
    picture.setTool(places[0], places[1], places[2]);
    if (!path.value || !status.line) return; // what was cut stays until the next run
    if (status.runTime < lastTime) [cut, lastLine] = [0, 0];
    lastTime = status.runTime;
    if (status.line === lastLine) return;
    cut = reached(path.value, cut, status.line);
    lastLine = status.line;
    picture.cutTo(cut);
  }
}

/** @param {import("../core/model.js").Loaded | null} loaded */
function noteOf(loaded) {
  if (!loaded) return t("alarm.noprogram");
  if (!pathOf) return `${loaded.name} \u00b7 ${t("graphics.notdrawn")}`;
  return loaded.seconds === null ? loaded.name : `${loaded.name} \u00b7 ${duration(loaded.seconds)}`;
}

/**
 * Draw what is loaded anew, unless it is not to be drawn.
 * @param {import("../core/model.js").Loaded | null} loaded
 */
function follow(loaded) {
  const load = loaded ? `${loaded.id} ${loaded.drawn}` : "";
  if (load === loadOf) return;
  loadOf = load;
  void begin(loaded?.drawn ? loaded.id : "");
}

/** @param {string} id */
async function begin(id) {
  pathOf = id;
  cut = 0;
  path.set(null); // that of another program is not shown under this name
  await read(id);
}

/** @param {string} id */
async function read(id) {
  const drawn = id ? await fetchPath("path") : null;
  if (pathOf === id) path.set(drawn);
}

/** The software limits of X, Y and Z, machine coordinates; null where they are not all known. */
function limitsOf() {
  const axes = ["X", "Y", "Z"].map((name) => model.axes.find((axis) => axis.name === name));
  const box = [...axes.map((axis) => axis?.low), ...axes.map((axis) => axis?.high)];
  return box.every((limit) => typeof limit === "number") ? /** @type {number[]} */ (box) : null;
}

/** Flip X, flip Y and exchange of the DISPLAY tab. */
async function readFlips() {
  const form = await get("forms/DISPLAY").catch(() => null);
  if (!form) return null;
  const rows = form.groups.flatMap((/** @type {any} */ group) => group.rows);
  const isOn = (/** @type {string} */ number) =>
    Boolean(rows.find((/** @type {any} */ row) => String(row.number) === number)?.number_value);
  return { x: isOn(FLIPS.x) ? -1 : 1, y: isOn(FLIPS.y) ? -1 : 1, exchange: isOn(FLIPS.exchange) };
}
