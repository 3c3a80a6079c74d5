// The shipped missions in steps, as the server lists them.

/** @typedef {Readonly<Record<string, string>>} ByLanguage */
/** @typedef {{ name: string, titles: ByLanguage, picture: string, stars: number, languages: readonly string[] }} Listed */
/** @typedef {{ name: string, titles: ByLanguage, missions: readonly Listed[] }} Step */

/** Where the server has the list. */
export const LIST = "missions.json";

/** @returns {Promise<readonly Step[] | null>}  null: the server did not answer */
export async function fetchMissions() {
  try {
    const answer = await fetch(LIST);
    return answer.ok ? ((await answer.json()).steps ?? []) : null;
  } catch {
    return null;
  }
}
