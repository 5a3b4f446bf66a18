// The bookmarks of the timeline: one is set, and each leads to its moment.
import { give } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";

const TEXTS = {
  marks: { en: "Bookmarks", de: "Lesezeichen" },
  mark: { en: "MARK", de: "MERKEN" },
  markText: { en: "Text of a bookmark", de: "Text eines Lesezeichens" },
};

/** @param {{ seconds: (tick: number) => string }} asked */
export function createMarks({ seconds }) {
  let isAsking = false;
  const marks = h("div.time-marks.scroll", { role: "group", tabIndex: 0, ariaLabel: t(TEXTS.marks) });
  const text = h("input.field.grow", { ariaLabel: t(TEXTS.markText), placeholder: t(TEXTS.markText), maxLength: 80 });
  const marking = h(
    "form.row",
    {
      onsubmit: (/** @type {Event} */ event) => {
        event.preventDefault();
        const typed = text.value.trim();
        if (!typed && isAsking) return; // pressed twice on a slow link
        text.value = "";
        isAsking = true;
        void give("timeline.mark", { text: typed }).then((done) => {
          isAsking = false;
          if (!done && !text.value) text.value = typed;
        });
      },
    },
    text,
    h("button.key", { type: "submit" }, t(TEXTS.mark)),
  );
  return {
    element: h("div", {}, marking, marks),
    /** @param {import("./lanes.js").Bookmark[]} bookmarks */
    list(bookmarks) {
      fill(
        marks,
        ...bookmarks.map((each) =>
          h(
            "button.key",
            {
              type: "button",
              data: { kind: each.kind },
              onclick: () => void give("timeline.seek", { tick: each.tick }),
            },
            `${seconds(each.tick)} s ${t(/** @type {any} */ (`time.kind.${each.kind}`))}: ${each.text}`,
          ),
        ),
      );
    },
  };
}
