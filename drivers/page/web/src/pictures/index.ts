import { cr3bp } from './cr3bp';
import { doublePendulum } from './double_pendulum';
import { henonHeiles } from './henon_heiles';
import { pcr3bp } from './pcr3bp';
import { pendulumChain } from './pendulum_chain';
import type { MakePicture, Picture } from './picture';
import { swingingSpring } from './swinging_spring';
import { threeBodies } from './three_bodies';

/** The picture of each system, by the name that archives have: a new one is a file and a line. Others have phase planes only. */
const pictures: Record<string, MakePicture> = {
  cr3bp: cr3bp,
  double_pendulum: doublePendulum,
  henon_heiles: henonHeiles,
  pcr3bp: pcr3bp,
  pendulum_chain: pendulumChain,
  swinging_spring: swingingSpring,
  three_bodies: threeBodies,
};

/** Whether there is one, in whatever coordinates. */
export function hasPicture(system: string): boolean {
  return Object.hasOwn(pictures, system);
}

/** None for a system that has none, or whose states are told otherwise. */
export function pictureOf(system: string, parameters: Record<string, number>, stateNames: string[]): Picture | null {
  const picture = hasPicture(system) ? pictures[system]!(parameters) : null;
  return picture?.coordinates.every((name, i) => stateNames[i] === name) ? picture : null;
}
