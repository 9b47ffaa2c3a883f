// A server component that finds pairs while it renders.
import { countPairs, init } from "sweep-and-prune";
import Client from "./client";

export const dynamic = "force-dynamic";

export default async function Page() {
  await init();
  return (
    <main>
      <p id="server">{countPairs([0, 1, 1, 2], { dimensions: 1 })} pair on the server</p>
      <Client />
    </main>
  );
}
