// Recent values for the plot: one series per value, as pairs of seconds and number.

/** @typedef {{ name: string, times: number[], values: number[] }} Series */

/** Ten minutes at ten samples per second. */
export const KEPT_POINTS = 6000;

export class History {
  constructor() {
    /** @type {Map<string, Series>} */ this.series = new Map();
  }

  /** @param {string} name @param {number} seconds @param {number} value */
  add(name, seconds, value) {
    let series = this.series.get(name);
    if (series === undefined || seconds < (series.times.at(-1) ?? seconds)) {
      series = { name, times: [], values: [] }; // time went backward: start over
      this.series.set(name, series);
    }
    series.times.push(seconds);
    series.values.push(value);
    if (series.times.length > KEPT_POINTS) {
      series.times.shift();
      series.values.shift();
    }
  }

  clear() {
    this.series.clear();
  }

  /** All series as rows: time, then one column per series. @returns {(string | number)[][]} */
  rows() {
    const all = [...this.series.values()];
    const times = [...new Set(all.flatMap((series) => series.times))].sort((one, other) => one - other);
    const columns = all.map(({ times: own, values }) => new Map(own.map((time, index) => [time, values[index]])));
    return [
      ["seconds", ...all.map(({ name }) => name)],
      ...times.map((time) => [time, ...columns.map((column) => column.get(time) ?? "")]),
    ];
  }
}
