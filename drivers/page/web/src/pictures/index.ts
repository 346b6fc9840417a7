import { doublePendulum } from './double_pendulum';
import { henonHeiles } from './henon_heiles';
import { pcr3bp } from './pcr3bp';
import type { MakePicture } from './picture';
import { swingingSpring } from './swinging_spring';

/** The picture of each system, by the name that archives have: a new one is a file and a line. Others have phase planes only. */
export const pictures: Record<string, MakePicture> = {
  double_pendulum: doublePendulum,
  henon_heiles: henonHeiles,
  pcr3bp: pcr3bp,
  swinging_spring: swingingSpring,
};
