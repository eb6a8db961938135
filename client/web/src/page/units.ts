// The units of the scene that is shown.

let photometric = false;

export const setPhotometric = (isPhotometric: boolean) => void (photometric = isPhotometric);

/** The name of irradiance and its unit. */
export const irradianceName = () => (photometric ? "Illuminance" : "Irradiance");
/** The name of the estimate of irradiance's error: one standard deviation. */
export const errorName = () => `Error of ${irradianceName().toLowerCase()}`;
export const irradianceUnit = () => (photometric ? "lx" : "W/m²");
/** The name of radiosity and its unit. */
export const radiosityName = () => (photometric ? "Luminous exitance" : "Radiosity");
export const radiosityUnit = () => (photometric ? "lm/m²" : "W/m²");
