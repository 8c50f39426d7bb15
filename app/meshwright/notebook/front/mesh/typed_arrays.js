// Typed arrays over the buffers of messages.

/** A typed array over a copy of a message's buffer (buffers may begin at odd addresses). */
export function arrayOf(Type, view) {
  const start = view.byteOffset;
  return new Type(view.buffer.slice(start, start + view.byteLength));
}

/** `array`, or a longer copy if it is shorter than `length`. */
export function withRoom(array, length) {
  if (length <= array.length) return array;
  const longer = new array.constructor(Math.max(length, Math.ceil(1.5 * array.length)));
  longer.set(array);
  return longer;
}
