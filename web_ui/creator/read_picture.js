// Reads an image file as a data URI that a playground can contain: small enough, in a format that the simulator reads.

/** Files up to this size are kept unchanged; as text they grow by a third. */
const KEPT_BYTES = 1_000_000;
const MOST_PIXELS = 2048;
/** An SVG has no size in pixels, so one is chosen. */
const DRAWN_PIXELS = 1600;
const QUALITY = 0.88;

/** Returns null if the file is not an image. @param {File} file @returns {Promise<string | null>} */
export async function readPicture(file) {
  const image = new Image();
  const address = URL.createObjectURL(file);
  image.src = address;
  try {
    await image.decode();
  } catch {
    return null;
  } finally {
    URL.revokeObjectURL(address);
  }
  const isVector = file.type === "image/svg+xml";
  const isPlain = file.type === "image/png" || file.type === "image/jpeg";
  const [width, height] = [image.naturalWidth || DRAWN_PIXELS, image.naturalHeight || DRAWN_PIXELS];
  if (isPlain && file.size <= KEPT_BYTES && Math.max(width, height) <= MOST_PIXELS) return uriOf(file);
  const wanted = isVector ? DRAWN_PIXELS : MOST_PIXELS;
  const scale = isVector ? wanted / Math.max(width, height) : Math.min(1, wanted / Math.max(width, height));
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
  return file.type === "image/jpeg" ? canvas.toDataURL("image/jpeg", QUALITY) : canvas.toDataURL("image/png");
}

/** @param {File} file @returns {Promise<string>} */
function uriOf(file) {
  return new Promise((resolve, fail) => {
    const reader = new FileReader();
    reader.onload = () => resolve(String(reader.result));
    reader.onerror = () => fail(reader.error);
    reader.readAsDataURL(file);
  });
}
