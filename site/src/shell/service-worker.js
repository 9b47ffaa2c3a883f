// Stores built pages for when there is no network: the article at once, and any other page when it is visited. The
// site's build fills in the names (see offline.ts). A new build has a new name, and takes over when no page of the old
// one is open, so that no page ever meets the files of another build.

const NAME = "__NAME__";
const FILES = __FILES__;
const ARTICLE = __ARTICLE__;

const address = (file) => new URL(file, self.registration.scope).href;
const built = new Set(FILES.map(address));

/** Without what a page does with its query, which is its own affair. */
function stored(address) {
  const url = new URL(address);
  url.search = "";
  url.hash = "";
  if (url.pathname.endsWith("/")) url.pathname += "index.html";
  return built.has(url.href) ? url.href : undefined;
}

self.addEventListener("install", (event) => {
  event.waitUntil(caches.open(NAME).then((cache) => cache.addAll(ARTICLE.map(address))));
});

self.addEventListener("activate", (event) => {
  const isOld = (name) => name.startsWith("pages-") && name !== NAME;
  const clear = async () => Promise.all((await caches.keys()).filter(isOld).map((name) => caches.delete(name)));
  event.waitUntil(clear());
});

// A page tells what it and its threads have loaded, also before this worker was there to see it.
self.addEventListener("message", (event) => {
  const keep = async () => {
    const cache = await caches.open(NAME);
    const missing = [];
    for (const url of new Set(event.data.loaded.map(stored))) if (url && !(await cache.match(url))) missing.push(url);
    await cache.addAll(missing);
    event.ports[0]?.postMessage("stored");
  };
  event.waitUntil(keep());
});

self.addEventListener("fetch", (event) => {
  const { request } = event;
  const url = request.method === "GET" ? stored(request.url) : undefined;
  if (!url) return;
  const answer = async () => {
    const cache = await caches.open(NAME);
    const found = await cache.match(url);
    if (found) return found;
    const response = await fetch(request);
    if (response.ok) await cache.put(url, response.clone());
    return response;
  };
  event.respondWith(answer());
});
