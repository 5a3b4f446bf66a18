// Curves of the scope.
export { default as uPlot } from "uplot";
