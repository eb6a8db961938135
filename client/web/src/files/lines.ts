// Lines of text files, and the numbers in them.

import { ImportError } from "./import_error";

export interface Line {
  number: number;
  keyword: string;
  /** What follows the keyword, without blanks at either end. */
  rest: string;
}

/** Yields the lines that are not empty, with lines that end in a backslash joined to the next ones. */
export function* linesOf(text: string, joined = true): Generator<Line> {
  const pieces = text.split("\n");
  for (let n = 0; n < pieces.length; ++n) {
    const number = n + 1;
    let line = pieces[n].replace(/\r$/, "");
    while (joined && line.endsWith("\\") && n + 1 < pieces.length) line = `${line.slice(0, -1)} ${pieces[++n].replace(/\r$/, "")}`;
    line = line.trim();
    const blank = line.search(/\s/);
    if (line === "") continue;
    yield blank < 0 ? { number, keyword: line, rest: "" } : { number, keyword: line.slice(0, blank), rest: line.slice(blank).trim() };
  }
}

export const wordsOf = (text: string) => (text === "" ? [] : text.split(/\s+/));

const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

export function isFiniteNumber(word: string): boolean {
  return NUMBER.test(word) && Number.isFinite(Number(word));
}

/** Returns the first three numbers of a line. Throws ImportError as import/obj_lines.cpp does. */
export function tripleOf({ number, keyword, rest }: Line, file = ""): [number, number, number] {
  const words = wordsOf(rest);
  const place = `${file ? `${file} ` : ""}line ${number}`;
  for (let k = 0; k < 3; ++k) {
    if (k >= words.length) throw new ImportError(place, `'${keyword}' needs three numbers`);
    if (!isFiniteNumber(words[k])) throw new ImportError(place, `'${words[k].slice(0, 40)}' is not a finite number`);
  }
  return [Number(words[0]), Number(words[1]), Number(words[2])];
}
