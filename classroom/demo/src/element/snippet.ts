/** The margins of a page that shows demos alone, and its last line, in CSS pixels. */
const MARGIN = 32;
const LAST_LINE = 32;

/**
 * What a reader copies to embed such a page: an iframe, for demos of this height and at most this width. The script, which a page may leave out,
 * gives it the height of what is in it: with that a narrow frame has no empty space below.
 */
export function iframeOf(url: string, title: string, height: number, width: number): string {
  const text = (value: string): string => value.replaceAll("&", "&amp;").replaceAll('"', "&quot;").replaceAll("<", "&lt;");
  return [
    `<iframe src="${text(url)}"`,
    `  title="${text(title)}"`,
    `  style="width: 100%; max-width: ${width + MARGIN}px; height: ${Math.ceil(height + MARGIN + LAST_LINE)}px; border: 0"`,
    `  loading="lazy"></iframe>`,
    `<script>addEventListener("message", ({ data, source }) => { for (const frame of document.querySelectorAll("iframe")) if (frame.contentWindow === source && data?.sapDemoHeight) frame.style.height = data.sapDemoHeight + "px"; });</script>`,
  ].join("\n");
}
