// The two doors of the module.
//
// mount(element, link, options) shows what a link tells; render({model, el}) is what anywidget calls.
//
// Places for other parts of the card, which are made where their classes exist:
//   new Timeline(element, card)   under the canvas; .update(head) with every state and patch
//   new Levels(element, card)     above it all;    .update(message) with every "level" message
// Both may have .release(). What they may use of the card: card.link.send(word, fields), card.mirror,
// card.colour("accent_soft"), card.say(tone, sentence), card.root, and card.follow(callback), which
// calls back after every change of theme.
//
// For tests and scripts, on the element of class "meshwright": data-revision (of the mesh that is
// painted), data-painted (how often it has been), data-halfedge (pointed at, -1 for none), data-meant
// (the operation whose ghost is shown), data-agent (what it is doing); and `element.meshwright` is the
// Card, whose screenOf(halfedge) gives the {x, y} of a half-edge on the page.

/** Show what `link` tells in `element`; returns the Card. options: {height, theme}. */
function mount(element, link, options = {}) {
  const card = new Card(link, options);
  element.append(card.root);
  card.retheme();
  return card;
}

/** A height that a canvas can have: marimo keeps what a page has set, though Python refused it. */
function canvasHeight(height) {
  return Number.isFinite(height) ? Math.min(Math.max(height, 160), 4000) : 464;
}

/** What anywidget calls for every view; returns what ends it. */
function render({ model, el }) {
  const link = new KernelLink(model);
  const wanted = () => ({ height: canvasHeight(model.get("height")), theme: model.get("theme") });
  const card = mount(el, link, wanted());
  const follow = () => card.configure(wanted());
  for (const name of ["height", "theme"]) model.on(`change:${name}`, follow);
  return () => {
    for (const name of ["height", "theme"]) model.off(`change:${name}`, follow);
    card.release();
  };
}
