// What the editor does with the project of the card: its text stored there, or that of the project opened.
import { model, refuse, report } from "../../core/app.js";
import { keyOf } from "../../core/keys.js";
import { t } from "../../core/texts.js";
import { hasProject, inProject, toProject } from "./card_text.js";

/** @typedef {import("./card_text.js").Opened} Opened */

/**
 * @param {{ opened: () => Opened, text: () => string, show: (opened: Opened) => void, mayDrop: () => Promise<boolean>,
 *   draw: () => void }} editor
 */
export function projectPart({ opened, text, show, mayDrop, draw }) {
  const saveKey = keyOf("texts.project.save", () => void save());
  const openKey = keyOf("texts.project.open", () => void open());
  const maySave = () => Boolean(opened().project && !opened().project?.why_not) && model.may("service");

  /** Store the text in the project; whether it is there. */
  async function save() {
    const stored = opened();
    try {
      const { file } = await toProject(stored, text());
      report(t("texts.project.saved", { name: stored.level, file }));
    } catch (error) {
      refuse(error);
      return false;
    }
    return true;
  }

  /** Open the text of the project instead of the card's; the card keeps its own until DOWNLOAD. */
  async function open() {
    const { project } = opened();
    if (project && (await mayDrop())) show({ ...opened(), text: project.text, isCards: false });
  }

  /** Read anew how the project has the program. */
  async function know() {
    const asked = opened();
    const project = await inProject(asked.level).catch(() => null);
    if (asked.level !== opened().level || !project) return;
    opened().project = project;
    draw();
  }

  return {
    keys: [saveKey, openKey],
    save,
    maySave,
    draw() {
      const { level, project } = opened();
      saveKey.hidden = !hasProject() || !level;
      saveKey.disabled = !maySave();
      saveKey.title = project?.why_not || t("texts.project.save");
      openKey.hidden = !project || project.is_same || !project.text;
    },
    /** That the card differs from the project, in words; empty where it does not. */
    differs() {
      const { project } = opened();
      return project && !project.is_same ? t("texts.project.differs", { file: project.file }) : "";
    },
    /** Follow texts that are stored; returns the function that ends it. */
    watch: () =>
      model.texts.watch((stored) => {
        if (stored && opened().level && ["", opened().level].includes(stored.name)) void know();
      }),
  };
}
