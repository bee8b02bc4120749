// What mdBook's pages lack for those who use a keyboard or hear them.

// The sidebar's switch is a label that says whether the sidebar is expanded, and that no key reaches.
// A button takes its place. mdBook's script sees clicks on the label, and expands by it.
{
  const label = document.getElementById("mdbook-sidebar-toggle");
  const button = document.createElement("button");
  for (const { name, value } of label?.attributes ?? []) if (name !== "for") button.setAttribute(name, value);
  button.type = "button";
  button.append(...(label?.childNodes ?? []));
  button.addEventListener("click", () => {
    label.dispatchEvent(new Event("click"));
    document.getElementById("mdbook-sidebar-toggle-anchor").click();
  });
  const expands = () => button.setAttribute("aria-expanded", label.getAttribute("aria-expanded"));
  if (label) new MutationObserver(expands).observe(label, { attributes: true });
  label?.replaceWith(button);
}

// The bar above the page is a landmark.
document.getElementById("mdbook-menu-bar")?.setAttribute("role", "banner");

// A cell above a column that needs no name is no header.
for (const header of document.querySelectorAll("main th")) {
  if (!header.textContent.trim()) header.replaceWith(document.createElement("td"));
}

// A header or a link of a formula alone has the formula's letters for a name: programs that name it by
// its text leave formulas out.
for (const math of document.querySelectorAll("main :is(th, a) math")) {
  const around = math.closest("th, a").cloneNode(true);
  for (const formula of around.querySelectorAll(".katex")) formula.remove();
  if (!around.textContent.trim()) math.setAttribute("aria-label", math.textContent);
}

// Parts that scroll can be reached by keyboard, to be scrolled. Whether a part scrolls depends on the width of
// the window and on the fonts, which arrive after the page.
{
  const parts = [...document.querySelectorAll("pre > code, .table-wrapper, .formula")];
  const update = (part) => {
    if (part.scrollWidth > part.clientWidth + 1) part.tabIndex = 0;
    else if (part !== document.activeElement) part.removeAttribute("tabindex");
  };
  const resized = new ResizeObserver((entries) => entries.forEach(({ target }) => update(target)));
  for (const part of parts) resized.observe(part);
  document.fonts.addEventListener("loadingdone", () => parts.forEach(update));
}
