// Prints the programs of VPL that the page offers to begin with, as one object of JSON by name.

import { LANGUAGES } from "../../web_ui/hosts/program_host.js";
import { sampleText } from "../../web_ui/vpl/view/samples.js";

const vpl = LANGUAGES.find(({ id }) => id === "vpl");
const samples = [...(vpl?.samples ?? []), ...(vpl?.more ?? [])];
console.log(JSON.stringify(Object.fromEntries(samples.map(({ name }) => [name, sampleText(name)]))));
