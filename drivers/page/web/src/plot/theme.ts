/** Colours of Okabe and Ito (2008), told apart with any colour vision, in order of use; lighter ones on dark paper. */
const lightFamilies = ['#0072b2', '#d55e00', '#009e73', '#b8479b', '#8a6d00', '#2f9bd8', '#5a4fcf', '#7a4b2a'];
const darkFamilies = ['#4ea8e8', '#ff8f3f', '#2fd1a2', '#ee9fd4', '#f0e442', '#8fd3ff', '#a99cff', '#d9a77c'];

export interface Theme {
  dark: boolean;
  paper: string;
  panel: string;
  ink: string;
  soft: string;
  grid: string;
  stable: string;
  unstable: string;
  unknown: string;
  pick: string;
  brush: string;
  families: string[];
  /** Pixels of the page's text. */
  text: number;
}

export function currentTheme(): Theme {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string): string => style.getPropertyValue(`--${name}`).trim();
  const dark = colour('dark') === '1';
  return {
    dark,
    paper: colour('paper'),
    panel: colour('panel'),
    ink: colour('ink'),
    soft: colour('soft'),
    grid: colour('grid'),
    stable: colour('stable'),
    unstable: colour('unstable'),
    unknown: colour('unknown'),
    pick: colour('pick'),
    brush: colour('brush'),
    families: dark ? darkFamilies : lightFamilies,
    text: parseFloat(style.fontSize) || 16,
  };
}

export function familyColour(theme: Theme, row: number): string {
  return theme.families[row % theme.families.length]!;
}
