// The client of `kake lsp` for Visual Studio Code: it starts the program and leaves the rest to it.
"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

function start() {
  const command = vscode.workspace.getConfiguration("kake").get("path") || "kake";
  const server = { command, args: ["lsp"] };
  client = new LanguageClient("kake", "Kakeami", server, {
    documentSelector: [
      { language: "kake" },
      // The server looks at those that are scenes, and passes over all others.
      { scheme: "file", pattern: "**/*.toml" },
    ],
  });
  return client.start().catch((error) => {
    vscode.window.showErrorMessage(
      `Kakeami: ${command} does not start (${error.message}). Install kake, or set "kake.path" to where it lies.`,
    );
  });
}

async function stop() {
  const running = client;
  client = undefined;
  // What has never started cannot be stopped.
  if (running) await running.stop().catch(() => {});
}

async function activate(context) {
  context.subscriptions.push(
    vscode.commands.registerCommand("kake.restart", async () => {
      await stop();
      await start();
    }),
    vscode.workspace.onDidChangeConfiguration(async (event) => {
      if (event.affectsConfiguration("kake.path")) {
        await stop();
        await start();
      }
    }),
  );
  await start();
}

module.exports = { activate, deactivate: stop };
