// Which painter a machine gets: WebGL with a GPU, else the two-dimensional canvas.
import { setting } from "../core/settings.js";
import { flatPainter } from "./flat.js";

const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** Whether WebGL here is drawn by a graphics card. */
function hasGpu() {
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) return false;
  const info = probe.getExtension("WEBGL_debug_renderer_info");
  const name = String(probe.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : probe.RENDERER));
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  return !SOFTWARE.test(name);
}

/**
 * @param {HTMLCanvasElement} canvas
 * @returns {Promise<import("./flat.js").Painter>}
 */
export async function painterFor(canvas) {
  const wanted = setting("renderer", "auto");
  const isSolid = wanted === "webgl" || (wanted === "auto" && hasGpu());
  canvas.dataset.renderer = isSolid ? "webgl" : "canvas";
  return isSolid ? (await import("./solid.js")).solidPainter(canvas) : flatPainter(canvas);
}
