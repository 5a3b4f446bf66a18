// A window that has one pane at a time.
export const NARROW = window.matchMedia("(max-width: 900px)");
