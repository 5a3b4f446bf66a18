/** The log-in page: sends role and password, shows why a log-in is refused. */

const form = /** @type {HTMLFormElement} */ (document.getElementById("login"));
const role = /** @type {HTMLSelectElement} */ (document.getElementById("role"));
const password = /** @type {HTMLInputElement} */ (document.getElementById("password"));
const refusal = /** @type {HTMLElement} */ (document.getElementById("refusal"));
const key = /** @type {HTMLButtonElement} */ (form.querySelector("button"));

/** @param {string} text */
function refuse(text) {
  refusal.textContent = text;
  refusal.hidden = text === "";
  password.setAttribute("aria-invalid", String(text !== ""));
}

/** Ask the server; the text of its refusal, or nothing. */
async function logIn() {
  try {
    const answer = await fetch("/api/login", {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ role: role.value, password: password.value }),
    });
    if (answer.ok) return "";
    return String((await answer.json()).error.text);
  } catch {
    return "The server does not answer: try again.";
  }
}

form.addEventListener("submit", async (event) => {
  event.preventDefault();
  refuse("");
  key.disabled = true;
  const text = await logIn();
  if (text === "") {
    window.location.replace("/");
    return;
  }
  key.disabled = false;
  refuse(text);
  password.select();
  password.focus();
});

if (new URLSearchParams(window.location.search).has("wrong")) refuse("The log-in was refused.");
