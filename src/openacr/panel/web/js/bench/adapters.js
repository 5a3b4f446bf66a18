// Modules as panes: those made for it, and screens and tabs of the operator's workspace in another place.
import { h } from "../core/dom.js";
import { Endings } from "../core/signal.js";

/**
 * A module that mounts itself.
 * @param {() => Promise<{ mount: import("./panes.js").Mount }>} load
 * @returns {() => Promise<import("./panes.js").Mount>}
 */
export function modulePane(load) {
  return async () => {
    const { mount } = await load();
    return (host, place) => {
      const body = h("div.screen-body", {});
      host.append(body);
      return mount(body, place);
    };
  };
}

/**
 * A screen as a pane.
 * @param {() => Promise<{ screen: import("../frame/screen_host.js").Screen }>} load
 * @returns {() => Promise<import("./panes.js").Mount>}
 */
export function screenPane(load) {
  return async () => {
    const { screen } = await load();
    return async (host, { head, beforeClose }) => {
      const endings = new Endings();
      const body = h("div.screen-body", { tabIndex: 0 });
      host.append(body);
      await screen.show({ body, head, endings, args: {}, setTitle: () => {}, beforeClose });
      return () => endings.end();
    };
  };
}

/**
 * A tab of the display window as a pane.
 * @param {() => Promise<(panel: HTMLElement, endings: Endings) => void | Promise<void>>} load
 * @returns {() => Promise<import("./panes.js").Mount>}
 */
export function tabPane(load) {
  return async () => {
    const show = await load();
    return async (host) => {
      const endings = new Endings();
      const panel = h("div.tab-panel", { tabIndex: 0 });
      host.append(panel);
      await show(panel, endings);
      return () => endings.end();
    };
  };
}
