import { RaceTrack } from "./race-track.ts";

customElements.define("race-track", RaceTrack);
