// Other tabs of this browser in which the editor of this page is open: they share its storage.

const CHANNEL = "thymio-editor";

/**
 * Call `met` when there is another tab, now or later; it is called in both.
 *
 * @param {() => void} met
 * @param {(name: string) => Pick<BroadcastChannel, "postMessage" | "onmessage">} [open]
 */
export function meetOtherTabs(met, open = (name) => new BroadcastChannel(name)) {
  const channel = open(CHANNEL);
  channel.onmessage = ({ data }) => {
    if (data === "opened") channel.postMessage("here");
    met();
  };
  channel.postMessage("opened");
}
