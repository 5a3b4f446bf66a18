// The 16 colours of the store. Written by `python -m openacr.panel.palette`; do not edit.
/** As the guide has them: texts and grounds of user messages. */
export const PLAIN = Object.freeze([
  "#000000",
  "#0000A8",
  "#00A800",
  "#00A8A8",
  "#A80000",
  "#A800A8",
  "#A85400",
  "#A8A8A8",
  "#545454",
  "#5454FC",
  "#54FC54",
  "#54FCFC",
  "#FC5454",
  "#FC54FC",
  "#FCFC54",
  "#FCFCFC",
]);
/** Colours of paths, for the ground of either theme. */
export const PENS = Object.freeze([
  "light-dark(#000000, #A3ADB7)",
  "light-dark(#0033CC, #5C8DFF)",
  "light-dark(#007A33, #2FA35C)",
  "light-dark(#00808A, #2AA5B0)",
  "light-dark(#B00020, #E5484D)",
  "light-dark(#8E24AA, #B65FD3)",
  "light-dark(#8B5A2B, #B57B45)",
  "light-dark(#8A8A8A, #C3C7CB)",
  "light-dark(#555555, #7A828A)",
  "light-dark(#3B82F6, #7FB2FF)",
  "light-dark(#009E73, #3DDC9A)",
  "light-dark(#1292A8, #4FD6EA)",
  "light-dark(#E4572E, #FF8A65)",
  "light-dark(#D957B5, #FF9BE0)",
  "light-dark(#AD8200, #FFD54A)",
  "light-dark(#6F8FAF, #FFFFFF)",
]);
