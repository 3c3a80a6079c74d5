// Which files are programs in Python.

/** Whether a file is a program in Python, by its name. @param {string} name */
export function isPython(name) {
  return /\.py$/i.test(name);
}
