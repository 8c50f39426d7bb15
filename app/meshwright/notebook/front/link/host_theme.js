// The theme of the page around the widget.

/** "light" or "dark": the theme of JupyterLab, marimo, Colab or VS Code, else of the system. */
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

/** Call `callback` when the theme may have changed; returns a function that ends this. */
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
