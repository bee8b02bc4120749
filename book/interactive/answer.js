// The answers of qrt: an index in JSON, in which a text stands for itself, [place] for a number and
// [place, length] for a list, and the numbers.

/** An answer by name: texts, numbers, and lists as Float64Array; `index` is its bytes. */
export function decode(index, numbers) {
  const answer = JSON.parse(new TextDecoder().decode(index));
  for (const [key, value] of Object.entries(answer)) {
    if (typeof value === "string") continue;
    const [start, length] = value;
    // A copy: the next call writes over it.
    answer[key] = length === undefined ? numbers[start] : numbers.slice(start, start + length);
  }
  return answer;
}
