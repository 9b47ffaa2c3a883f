import base from "./vite.config.ts";
const alias=[{find:/.*simulation\/wasm\/simulation\.js$/,replacement:"/tmp/stub/simulation.js"}];
export default {...base, root:"/work/main/site", resolve:{alias}, build:{...base.build,outDir:"/tmp/stub/dist",emptyOutDir:true}};
