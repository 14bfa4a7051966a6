// The material that shows tangent frames as colours, on the surface and in the UV layout.

import { DoubleSide, ShaderMaterial, Matrix3, type Matrix4 } from 'three';

import { PAINTS, type Paint } from '../settings';

/** The logarithmic colour scale of angles in degrees: its ends and its ticks. The command's heat maps have the same scale. */
export const SCALE = { ends: [0.01, 180], ticks: [0.01, 0.1, 1, 10, 180] } as const;

/** The colours of the scale: nine colours of viridis (N. Smith and S. van der Walt, 2015, CC0), whose lightness grows evenly. */
export const RAMP = ['#440154', '#472c7a', '#3b518b', '#2c718e', '#21908d', '#27ad81', '#5cc863', '#aadc32', '#fde725'] as const;

/** The colours of values that are not on the scale. */
export const COLORS = { plus: '#3d8bd9', minus: '#e8873a', flipped: '#e62828', stripe: '#ffffff', none: '#000000' } as const;

const VERTEX = /* glsl */ `
attribute vec4 frame;
attribute vec2 chart;
attribute float angle;
varying vec3 vTangent;
varying vec3 vNormal;
varying float vSign;
varying float vAngle;
varying vec3 vEye;
uniform mat3 place;
// Transforms directions to world space.
flat varying mat3 vPlace;

void main() {
  vPlace = place;
  vec4 local = vec4(position, 1.0);
  #ifdef USE_INSTANCING
    vPlace = place * mat3(instanceMatrix);
    local = instanceMatrix * local;
  #endif
  vTangent = frame.xyz;
  vNormal = normal;
  vSign = frame.w;
  vAngle = angle;
  vec4 eye = modelViewMatrix * local;
  vEye = eye.xyz;
  gl_Position = projectionMatrix * eye;
  #ifdef LAYOUT
    gl_Position = projectionMatrix * viewMatrix * vec4(chart, 0.0, 1.0);
  #endif
}`;

const color = (hex: string) => {
  const parts = [1, 3, 5].map((at) => (parseInt(hex.slice(at, at + 2), 16) / 255).toFixed(4));
  return `vec3(${parts.join(', ')})`;
};

const FRAGMENT = /* glsl */ `
uniform int paint;
flat varying mat3 vPlace;
varying vec3 vTangent;
varying vec3 vNormal;
varying float vSign;
varying float vAngle;
varying vec3 vEye;

const vec3 RAMP[${RAMP.length}] = vec3[${RAMP.length}](${RAMP.map(color).join(', ')});

vec3 heat(float degrees) {
  if (degrees < -0.5) return ${color(COLORS.none)};
  // FLIPPED and NO_ANGLE are no angles.
  // Stripes tell opposite signs from angles without the hue.
  if (degrees > 180.5) return mod(gl_FragCoord.x + gl_FragCoord.y, 8.0) < 3.0 ? ${color(COLORS.stripe)} : ${color(COLORS.flipped)};
  float least = log(float(${SCALE.ends[0]}));
  float most = log(float(${SCALE.ends[1]}.0));
  float at = clamp((log(max(degrees, 1e-6)) - least) / (most - least), 0.0, 1.0) * float(${RAMP.length - 1});
  int below = min(int(at), ${RAMP.length - 2});
  return mix(RAMP[below], RAMP[below + 1], at - float(below));
}

vec3 direction(vec3 v) {
  vec3 seen = vPlace * v;
  float l = length(seen);
  return l > 0.0 ? 0.5 + 0.5 * seen / l : vec3(0.0);
}

void main() {
  vec3 color = vec3(0.6);
  if (paint == ${PAINTS.indexOf('tangent')}) color = direction(vTangent);
  if (paint == ${PAINTS.indexOf('bitangent')}) color = direction(cross(vNormal, vTangent) * vSign);
  if (paint == ${PAINTS.indexOf('normal')}) color = direction(vNormal);
  if (paint == ${PAINTS.indexOf('sign')}) color = vSign > 0.0 ? ${color(COLORS.plus)} : vSign < 0.0 ? ${color(COLORS.minus)} : ${color(COLORS.none)};
  if (paint == ${PAINTS.indexOf('angle')}) color = heat(vAngle);
  #ifdef LAYOUT
    #ifdef EDGES
      gl_FragColor = vec4(0.06, 0.07, 0.09, 0.7);
    #else
      gl_FragColor = vec4(color, 0.6);
    #endif
  #else
    // A weak light from the camera makes the shape visible.
    float facing = abs(dot(normalize(cross(dFdx(vEye), dFdy(vEye))), normalize(vEye)));
    gl_FragColor = vec4(color * (0.75 + 0.25 * facing), 1.0);
  #endif
}`;

/** Makes the material. `place` is the world matrix of the part's node. */
export function frameMaterial(paint: Paint, place: Matrix4, isLayout: boolean): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    defines: isLayout ? { LAYOUT: '' } : {},
    uniforms: { paint: { value: PAINTS.indexOf(paint) }, place: { value: new Matrix3().setFromMatrix4(place) } },
    side: DoubleSide,
    transparent: isLayout,
    depthTest: !isLayout,
    polygonOffset: !isLayout,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}
