/* What scrolls can be reached by the keyboard, headings of the contents have a level, parts of the page a name; heads
   of columns with nothing to read are no heads. */
const NAMES = { "aside.sidebar-drawer": "Contents", "aside.toc-drawer": "On this page", ".content-icon-container": "View" };
function makeReachable() {
  for (const [part, name] of Object.entries(NAMES))
    for (const found of document.querySelectorAll(part)) {
      found.setAttribute("aria-label", name);
      if (found.tagName === "DIV") found.setAttribute("role", "navigation");
    }
  if (!document.querySelector("h1")) {
    const heading = document.createElement("h1");
    heading.className = "visually-hidden";
    heading.textContent = document.title;
    document.querySelector("[role=main]").prepend(heading);
  }
  for (const cell of document.querySelectorAll("th.head"))
    if (!cell.textContent.trim()) cell.replaceWith(Object.assign(document.createElement("td"), { className: "head" }));
  for (const heading of document.querySelectorAll("p.caption[role=heading]")) heading.setAttribute("aria-level", "2");
  for (const box of document.querySelectorAll("pre, .table-wrapper, div.math, .toc-scroll, .sidebar-scroll"))
    if (box.scrollWidth > box.clientWidth || box.scrollHeight > box.clientHeight) box.tabIndex = 0;
    else box.removeAttribute("tabindex");
}
addEventListener("load", makeReachable);
addEventListener("resize", makeReachable);
