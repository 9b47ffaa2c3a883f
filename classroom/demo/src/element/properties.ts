import { attributes, booleans, isOn } from "./options.js";

/** Makes every attribute a property as well, but for those that would hide one that elements have. */
export function addProperties(prototype: HTMLElement): void {
  for (const name of attributes) {
    const property = name.replace(/-(\w)/g, (_, letter: string) => letter.toUpperCase());
    if (property in prototype) continue;
    Object.defineProperty(prototype, property, {
      configurable: true,
      get(this: HTMLElement) {
        const value = this.getAttribute(name);
        return booleans.has(name) ? isOn(value) : value;
      },
      set(this: HTMLElement, value: unknown) {
        if (value === null || value === undefined || value === false) this.removeAttribute(name);
        else this.setAttribute(name, value === true ? "" : typeof value === "object" ? JSON.stringify(value) : String(value));
      },
    });
  }
}
