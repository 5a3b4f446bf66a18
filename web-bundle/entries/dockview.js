// Panes of the engineer's workspace.
export { createDockview } from "dockview-core";
