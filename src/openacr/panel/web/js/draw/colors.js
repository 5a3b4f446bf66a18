// The 16 colours of the guide's screens, darkened where they would not show on white.
export const COLORS = Object.freeze([
  "#000000", "#0033CC", "#007A33", "#00808A", "#B00020", "#8E24AA", "#8B5A2B", "#9E9E9E",
  "#555555", "#3B82F6", "#009E73", "#17A2B8", "#E4572E", "#E573C7", "#D9A400", "#C8BFB0",
]);
export const BLACK = 0; // the text's colour where it is drawn on the ground of a theme
