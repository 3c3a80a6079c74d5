// Which files are missions. Pure.

const ZIP = [0x50, 0x4b, 0x03, 0x04];
const NAME = "mission.json";

/** Whether a file is a mission: JSON with facts and a condition for success, or a ZIP archive with one. @param {Uint8Array} bytes */
export function looksLikeMission(bytes) {
  if (ZIP.every((byte, at) => bytes[at] === byte)) return new TextDecoder("latin1").decode(bytes).includes(NAME);
  try {
    const data = JSON.parse(new TextDecoder().decode(bytes));
    return typeof data === "object" && data !== null && "facts" in data && "success" in data;
  } catch {
    return false;
  }
}
