// Rules for the modules of src/openacr/panel/web/js and their tests; Prettier formats them.
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
      "max-lines": ["error", { max: 400, skipBlankLines: true, skipComments: true }],
    },
  },
  { files: ["tests/panel/web/*.js"], languageOptions: { globals: globals.node } },
  { files: ["**/catalog/*.js"], rules: { "max-lines": "off" } }, // tables of texts
];
