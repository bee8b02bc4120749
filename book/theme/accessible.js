// What mdBook's pages lack for those who use a keyboard or hear them.

// The sidebar's switch is a label that says whether it is expanded: a button, by what it does.
document.getElementById("mdbook-sidebar-toggle")?.setAttribute("role", "button");

// Listings that scroll can be reached by keyboard, to be scrolled.
for (const code of document.querySelectorAll("pre > code, .table-wrapper, .formula, .qrt-frame")) {
  if (code.scrollWidth > code.clientWidth + 1) code.tabIndex = 0;
}
