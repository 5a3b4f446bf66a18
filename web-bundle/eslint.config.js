// Rules for the modules of src/openacr/panel/web/js; formatting is left to the reader's eye.
import js from "@eslint/js";
import globals from "globals";

export default [
  { ...js.configs.recommended, languageOptions: { globals: globals.browser } },
  {
    rules: {
      eqeqeq: "error",
      "no-eval": "error",
      "no-implied-eval": "error",
      "no-implicit-globals": "error",
      "no-restricted-properties": [
        "error",
        { property: "innerHTML", message: "Texts are text: use textContent." },
        { property: "outerHTML", message: "Texts are text: use textContent." },
        { property: "insertAdjacentHTML", message: "Texts are text: use textContent." },
      ],
      "no-shadow": "error",
      "no-var": "error",
      "prefer-const": "error",
      "max-lines": ["error", 300],
    },
  },
];
