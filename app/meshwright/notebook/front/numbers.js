// Bounds and formats of numbers.

/** `value`, or the bound of [low, high] that it exceeds. */
export function clamp(value, low, high) {
  return Math.min(Math.max(value, low), high);
}

/** "+1", with a true minus sign for negative numbers. */
export function signed(number) {
  if (number > 0) return `+${number.toLocaleString("en")}`;
  return number < 0 ? `\u2212${(-number).toLocaleString("en")}` : "0";
}

/** "1 quad", "1,200 quads". */
export function counted(count, one, many = `${one}s`) {
  return `${count.toLocaleString("en")} ${count === 1 ? one : many}`;
}
