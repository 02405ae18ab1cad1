// Elements of the page, with the types that their tags have.

/**
 * The one with that id.
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {string} id
 * @returns {HTMLElementTagNameMap[Tag]}
 */
export const the = (tag, id) => document.querySelector(`${tag}#${id}`);

/**
 * A new one, the last in its parent.
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Element} parent
 * @param {Tag} tag
 */
export function made(parent, tag, className = "", text = "", role = "") {
  const element = document.createElement(tag);
  if (role) element.setAttribute("role", role);
  element.className = className;
  element.textContent = text;
  parent.append(element);
  return element;
}
