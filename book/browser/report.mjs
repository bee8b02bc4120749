// The command line of the test, the command `qrt`, and the faults that were found.

import { execFileSync } from "node:child_process";

export const [folder, root] = process.argv.slice(2);
export const { CHROMIUM, QRT, SCREENSHOTS } = process.env;

export const failures = [];

export function fail(where, what) {
  failures.push(`${where}: ${what}`);
  console.error(`FAILED  ${where}: ${what}`);
}

/** Fails if something takes longer than `most` milliseconds, where times are judged: other processes lengthen them. */
export function inTime(where, what, took, most) {
  if (process.env.TIMES && took > most) fail(where, `${what} takes ${took.toFixed(0)} ms, more than ${most}`);
}

/** Compares a number of the page with qrt's. */
export function check(where, name, found, expected, tolerance = 0) {
  const close = Math.abs(found - expected) <= tolerance * Math.max(1, Math.abs(expected));
  if (!close) fail(where, `${name} is ${found}, but qrt says ${expected}`);
}

/** Compares two lists: says how many differ, and how the first. */
export function checkAll(where, name, found, expected, tolerance = 0) {
  check(where, `the number of ${name}`, found.length, expected.length);
  const differ = expected.flatMap((value, k) => {
    const close = Math.abs(found[k] - value) <= tolerance * Math.max(1, Math.abs(value));
    return close ? [] : [k];
  });
  if (differ.length) {
    const [k] = differ;
    fail(where, `${differ.length} of the ${name} differ from qrt's; number ${k} is ${found[k]}, but qrt says ${expected[k]}`);
  }
}

/** Returns what the command prints. */
export const qrt = (...args) => execFileSync(QRT, args, { cwd: root, encoding: "utf8", maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "pipe"] });
