// What the page around the widget says: light or dark.

/** "light" or "dark", as JupyterLab, marimo, Colab or VS Code say, else as the system does. */
export function hostTheme() {
  const body = document.body;
  if (body.dataset.jpThemeLight !== undefined) {
    return body.dataset.jpThemeLight === "false" ? "dark" : "light";
  }
  const kinds = [document.documentElement, body];
  if (kinds.some((part) => part.matches(".vscode-dark, .vscode-high-contrast"))) return "dark";
  if (kinds.some((part) => part.matches(".vscode-light"))) return "light";
  if (kinds.some((part) => part.matches(".dark, .dark-theme, [data-theme='dark'], [theme='dark']"))) return "dark";
  if (kinds.some((part) => part.matches(".light, .light-theme, [data-theme='light'], [theme='light']"))) return "light";
  return matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}

/** Call back whenever the page's theme may be another; returns what ends that. */
export function watchHost(callback) {
  const observer = new MutationObserver(callback);
  const wanted = { attributes: true, attributeFilter: ["class", "theme", "data-theme", "data-jp-theme-light"] };
  observer.observe(document.body, wanted);
  observer.observe(document.documentElement, wanted);
  const system = matchMedia("(prefers-color-scheme: dark)");
  system.addEventListener("change", callback);
  return () => {
    observer.disconnect();
    system.removeEventListener("change", callback);
  };
}
