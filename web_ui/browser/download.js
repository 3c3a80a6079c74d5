// Saves a file on the user's computer.

/** @param {string} name @param {string | Uint8Array<ArrayBuffer>} content @param {string} type  MIME type */
export function download(name, content, type) {
  const address = URL.createObjectURL(new Blob([content], { type }));
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 0);
}
