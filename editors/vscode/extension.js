// Starts `openacr lsp` and `openacr debug`, and runs `openacr` in tasks. What is true of the
// languages is in openacr itself; here is only what the editor needs to call it.
"use strict";

const { spawn } = require("node:child_process");
const path = require("node:path");
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

const CONTROLLER = ["acrobasic", "acroplc"];
const LANGUAGES = [...CONTROLLER, "rs274"];

let client;

/** A setting of the extension, as it is for a file. */
function setting(name, uri) {
  return vscode.workspace.getConfiguration("openacr", uri).get(name);
}

/** The options that say for which machine and in which dialect part programs are read. */
function machine(uri) {
  const found = [];
  for (const name of ["store", "dialect"]) {
    const value = setting(name, uri);
    if (value) found.push(`--${name}`, value);
  }
  return found;
}

async function startServer() {
  const server = { command: setting("path"), args: ["lsp", ...machine()] };
  const documentSelector = LANGUAGES.map((language) => ({ scheme: "file", language }));
  client = new LanguageClient("openacr", "openacr", server, { documentSelector });
  try {
    await client.start();
  } catch (error) {
    vscode.window.showErrorMessage(
      `openacr: the language server does not start: ${error?.message ?? error} ` +
        "Is openacr[lsp] installed, and is the setting openacr.path its path?",
    );
  }
}

async function stopServer() {
  const running = client;
  client = undefined;
  if (running && running.needsStop()) await running.stop();
}

async function restartServer() {
  await stopServer();
  await startServer();
}

/** The saved file in the active editor; undefined, with a message, if it is of no use here. */
async function activeDocument(languages) {
  const document = vscode.window.activeTextEditor?.document;
  if (!document || document.uri.scheme !== "file" || !languages.includes(document.languageId)) {
    vscode.window.showErrorMessage(`openacr: open a file of ${languages.join(", ")} first.`);
    return undefined;
  }
  return (await document.save()) ? document : undefined;
}

/** What openacr calls the project of a file: its folder with a set-up or machine file, or the file. */
async function projectOf(uri) {
  const folder = vscode.Uri.joinPath(uri, "..");
  for (const name of ["setup.8k", "machine.toml"]) {
    try {
      await vscode.workspace.fs.stat(vscode.Uri.joinPath(folder, name));
      return folder.fsPath;
    } catch {
      // not there: the next one
    }
  }
  return uri.fsPath;
}

/** Run openacr as a task; its findings are shown as problems. The exit code, or undefined. */
async function runTask(uri, title, words) {
  const scope = vscode.workspace.getWorkspaceFolder(uri) ?? vscode.TaskScope.Workspace;
  const options = { cwd: path.dirname(uri.fsPath) };
  const execution = new vscode.ProcessExecution(setting("path", uri), words, options);
  const definition = { type: "process" };
  const task = new vscode.Task(definition, scope, title, "openacr", execution, "$openacr");
  const ended = new Promise((resolve) => {
    const listener = vscode.tasks.onDidEndTaskProcess((event) => {
      if (event.execution.task.name !== title || event.execution.task.source !== "openacr") return;
      listener.dispose();
      resolve(event.exitCode);
    });
  });
  await vscode.tasks.executeTask(task);
  return ended;
}

async function check() {
  const document = await activeDocument(LANGUAGES);
  if (!document) return;
  const isController = CONTROLLER.includes(document.languageId);
  const words = isController
    ? ["check", await projectOf(document.uri)]
    : ["mill", "check", document.uri.fsPath, ...machine(document.uri)];
  await runTask(document.uri, "check", words);
}

async function run() {
  const document = await activeDocument(CONTROLLER);
  if (document) await runTask(document.uri, "run", ["run", await projectOf(document.uri)]);
}

/** Draw the motion of a project or the path of a part program, and open the page. */
async function plot() {
  const document = await activeDocument(LANGUAGES);
  if (!document) return;
  const picture = `${document.uri.fsPath}.html`;
  const isController = CONTROLLER.includes(document.languageId);
  const words = isController
    ? ["run", await projectOf(document.uri), "--plot", picture]
    : ["mill", "plot", document.uri.fsPath, picture, ...machine(document.uri)];
  if ((await runTask(document.uri, "plot", words)) === 0) {
    await vscode.env.openExternal(vscode.Uri.file(picture));
  }
}

/** The debugger is `openacr debug`, on its standard input and output. */
const debuggerFactory = {
  createDebugAdapterDescriptor(session) {
    const command = setting("path", session.workspaceFolder?.uri);
    return new vscode.DebugAdapterExecutable(command, ["debug"]);
  },
};

/** F5 without a launch.json debugs the active part program, or the project of the active file. */
async function activeConfiguration() {
  const document = await activeDocument(LANGUAGES);
  if (!document) return undefined;
  const launch = { type: "openacr", request: "launch", stopOnEntry: true };
  if (CONTROLLER.includes(document.languageId)) {
    return { ...launch, name: "Project", program: await projectOf(document.uri) };
  }
  const { uri } = document;
  const [store, dialect] = ["store", "dialect"].map((name) => setting(name, uri));
  return { ...launch, name: "Part program", partProgram: uri.fsPath, store, dialect };
}

/** Why a program does not start; undefined if it does. */
function reasonAgainst(command) {
  return new Promise((resolve) => {
    const child = spawn(command, ["--version"], { stdio: "ignore" });
    child.once("error", (error) => resolve(error.message));
    child.once("spawn", () => resolve(undefined));
  });
}

/** The editor itself says nothing where the program of a debugger does not start. */
const debugConfigurations = {
  async resolveDebugConfiguration(folder, configuration) {
    const isGiven = configuration.type || configuration.request || configuration.name;
    const resolved = isGiven ? configuration : await activeConfiguration();
    const reason = resolved && (await reasonAgainst(setting("path", folder?.uri)));
    if (!reason) return resolved;
    vscode.window.showErrorMessage(
      `openacr: the debugger does not start: ${reason}. Is the setting openacr.path its path?`,
    );
    return undefined;
  },
};

async function activate(context) {
  context.subscriptions.push(
    vscode.commands.registerCommand("openacr.check", check),
    vscode.commands.registerCommand("openacr.run", run),
    vscode.commands.registerCommand("openacr.plot", plot),
    vscode.commands.registerCommand("openacr.restartServer", restartServer),
    vscode.debug.registerDebugAdapterDescriptorFactory("openacr", debuggerFactory),
    vscode.debug.registerDebugConfigurationProvider("openacr", debugConfigurations),
    vscode.workspace.onDidChangeConfiguration(async (event) => {
      if (event.affectsConfiguration("openacr")) await restartServer();
    }),
  );
  await startServer();
}

module.exports = { activate, deactivate: stopServer };
