// Keeps the built pages for when there is no network. The site's build fills in what there is
// (see offline.ts); a new build has a new name, and takes over when no page of the old one is open,
// so that no page ever meets the files of another build.

const NAME = "__NAME__";
const FILES = __FILES__;

const address = (file) => new URL(file, self.registration.scope).href;
const kept = new Set(FILES.map(address));

self.addEventListener("install", (event) => {
  event.waitUntil(caches.open(NAME).then((cache) => cache.addAll(FILES.map(address))));
});

self.addEventListener("activate", (event) => {
  const isOld = (name) => name.startsWith("pages-") && name !== NAME;
  const clear = async () => Promise.all((await caches.keys()).filter(isOld).map((name) => caches.delete(name)));
  event.waitUntil(clear());
});

self.addEventListener("fetch", (event) => {
  const { request } = event;
  if (request.method !== "GET") return;
  const url = new URL(request.url);
  url.search = ""; // what a page does with its query is its own affair
  url.hash = "";
  if (url.pathname.endsWith("/")) url.pathname += "index.html";
  if (!kept.has(url.href)) return;
  event.respondWith(caches.match(url.href).then((found) => found ?? fetch(request)));
});
