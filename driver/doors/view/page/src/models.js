// SPDX-License-Identifier: MIT
/** Draws the models of the scene with the plugin's own triangles and normals, so that they look as they feel. A body
 * that deforms is updated. A stain of colour shows where the probe touches a surface. */
import {Box3, BufferAttribute, BufferGeometry, Color, DoubleSide, Group, LineBasicMaterial, LineSegments, Mesh,
  MeshLambertMaterial, Vector4, WireframeGeometry} from 'three';
import {toCreasedNormals} from 'three/addons/utils/BufferGeometryUtils.js';
import {colourOf, vertexColours} from './colours.js';
import {placeBehind, seamsOf} from './seams.js';

const kCrease = Math.PI / 5; // rad: if a plugin gives no normals, edges that bend by more than this stay sharp
const kStains = 4; // largest number of contacts that colour one surface at a time

const kFragmentHead = `varying vec3 vPlace;
uniform vec4 stains[${kStains}];
uniform float stainRadius;
uniform vec3 stainColor;
`;
const kFragmentStain = `
  float stain = 0.0;
  for (int i = 0; i < ${kStains}; ++i) {
    vec3 away = (vPlace - stains[i].xyz) / stainRadius;
    stain = max(stain, stains[i].w * exp(-dot(away, away)));
  }
  outgoingLight = mix(outgoingLight, stainColor, stain);
  #include <opaque_fragment>`;

const noStains = () => ({
  stains: {value: Array.from({length: kStains}, () => new Vector4(0, 0, 0, 0))},
  stainRadius: {value: 0.01},
  stainColor: {value: new Color('#ff4d12')},
});

/** Makes a material with Lambert's shading and a warm stain about each contact. A stain has a place in the world and a
 * strength. @param colour one `color`, or `vertexColors` @param uniforms the stains @param behind true for seams */
function stainedMaterial(colour, uniforms = noStains(), behind = false) {
  const material = new MeshLambertMaterial({side: DoubleSide, ...colour});
  material.userData = uniforms;
  material.customProgramCacheKey = () => `stained${behind ? ' behind' : ''}`;
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = `varying vec3 vPlace;\n${shader.vertexShader}`.replace('#include <project_vertex>',
      '#include <project_vertex>\nvPlace = (modelMatrix * vec4(transformed, 1.0)).xyz;');
    shader.fragmentShader = kFragmentHead + shader.fragmentShader.replace('#include <opaque_fragment>', kFragmentStain);
    if (behind) placeBehind(shader);
  };
  return material;
}

export class Models {
  constructor() {
    this.group = new Group();
    this.byIndex = new Map();
    this.balls = new Map(); // index -> [m] radius of the ball that touches the model, 0 for a point; its foot point is so far above the surface
  }

  /** Removes all models. */
  clear() {
    for (const index of [...this.byIndex.keys()]) this.remove(index);
  }

  remove(index) {
    const model = this.byIndex.get(index);
    if (!model) return;
    this.group.remove(model.mesh);
    model.mesh.geometry.dispose();
    model.mesh.material.dispose();
    model.seams?.geometry.dispose();
    model.seams?.material.dispose();
    this.byIndex.delete(index);
  }

  /** Adds a model with its triangles {xyz, normals, corners, colours} and pose {position, orientation}. */
  add(index, {name, plugin, pose, deforms}, triangles) {
    this.remove(index);
    const live = new BufferGeometry(); // gets the new vertices of a body that deforms
    live.setAttribute('position', new BufferAttribute(triangles.xyz, 3));
    live.setIndex(new BufferAttribute(triangles.corners, 1));
    if (triangles.normals) live.setAttribute('normal', new BufferAttribute(triangles.normals, 3));
    else live.computeVertexNormals();
    const own = colourOf(plugin, index);
    if (triangles.colours) live.setAttribute('color', new BufferAttribute(vertexColours(triangles.colours, own), 3));
    const colour = triangles.colours ? {vertexColors: true} : {color: own}, material = stainedMaterial(colour);
    const mesh = new Mesh(triangles.normals ? live : toCreasedNormals(live, kCrease), material);
    mesh.name = name;
    if (pose) placeMesh(mesh, pose);
    const lines = deforms ? null : seamsOf(mesh.geometry);
    const seams = lines && new LineSegments(lines, stainedMaterial(colour, material.userData, true));
    if (seams) mesh.add(seams);
    this.byIndex.set(index, {name, plugin, deforms, mesh, live, seams, edges: null, triangles: triangles.corners.length / 3});
    this.group.add(mesh);
  }

  deforms(index) {
    return this.byIndex.get(index)?.deforms === true;
  }

  /** Sets the new vertices of a body that deforms. */
  deform(index, xyz) {
    const model = this.byIndex.get(index);
    const position = model?.live.getAttribute('position');
    if (!position || position.count * 3 !== xyz.length) return;
    if (model.mesh.geometry !== model.live) {
      model.mesh.geometry.dispose();
      model.mesh.geometry = model.live;
    }
    position.copyArray(xyz).needsUpdate = true;
    model.live.computeVertexNormals();
    model.live.computeBoundingSphere();
  }

  /** Moves a model, unless its pose is unknown. */
  move(index, pose) {
    const model = this.byIndex.get(index);
    if (model && pose) placeMesh(model.mesh, pose);
  }

  /** Returns the radius [m] of the ball that touches a model; 0 for a point. */
  ball(index) {
    return this.balls.get(index) ?? 0;
  }

  /** Colours the surfaces about the present contacts. @param full [m] depth at which the colour is strongest */
  stain(contacts, full) {
    for (const [index, model] of this.byIndex) {
      const mine = contacts.filter((c) => c.model === index && c.depth > 0);
      model.mesh.material.userData.stains.value.forEach((stain, i) => {
        const c = mine[i];
        if (c) stain.set(...c.point.map((x, k) => x - this.ball(index) * c.normal[k]), 0.3 + 0.65 * Math.min(1, c.depth / full));
        else stain.w = 0;
      });
    }
  }

  wire(shown) {
    for (const model of this.byIndex.values()) {
      if (shown && !model.edges) {
        const material = new LineBasicMaterial({color: '#22303c', transparent: true, opacity: 0.25});
        model.edges = new LineSegments(new WireframeGeometry(model.mesh.geometry), material);
        model.mesh.add(model.edges);
      }
      if (model.edges) model.edges.visible = shown;
    }
  }

  stainRadius(radius) {
    for (const model of this.byIndex.values()) model.mesh.material.userData.stainRadius.value = radius;
  }

  box() {
    const box = new Box3();
    for (const model of this.byIndex.values()) box.expandByObject(model.mesh);
    return box;
  }
}

function placeMesh(mesh, {position, orientation}) {
  const [w, x, y, z] = orientation;
  mesh.position.set(...position);
  mesh.quaternion.set(x, y, z, w);
}
