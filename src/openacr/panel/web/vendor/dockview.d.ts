export { createDockview } from "dockview-core";
export type {
  DockviewApi,
  DockviewPanelApi,
  GroupPanelPartInitParameters,
  IContentRenderer,
  IDockviewPanel,
  ITabRenderer,
  SerializedDockview,
  TabPartInitParameters,
} from "dockview-core";
