// Whether a file has a VPL program, without the modules of VPL: the page asks it of every file.

/** The elements of VPL of Aseba and of extended programs; `<` is written in another way in the text of programs. */
const ROOTS = /<(?:vplroot|ThymioSimVpl)[\s/>]/;

/** @param {string} text */
export function holdsVpl(text) {
  return ROOTS.test(text);
}
