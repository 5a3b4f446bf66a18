export * from "three";
export { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
export { STLLoader } from "three/addons/loaders/STLLoader.js";
